//! Settings for each kind of data: shapes, colours and a view, if nobody says so.

use pinhole::camera::Viewpoint;
use pinhole::glam::DVec3;
use pinhole_data::kind::{Kind, Traits};

use crate::settings::keys_of;
use crate::style::Style;

/// Settings for a kind of data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KindSettings {
    /// The settings about data: keys of a scene file.
    pub data: String,
    /// The style, with its background, if it is not the usual one of data.
    pub style: Option<Style>,
    /// Changes of the style: keys of a scene file, for pictures whose style nobody changes otherwise.
    pub look: String,
    /// The view.
    pub view: Option<KindView>,
    /// Notes for the user about what is not drawn.
    pub notes: Vec<KindNote>,
}

/// A view of data.
#[derive(Clone, Debug, PartialEq)]
pub struct KindView {
    /// The kind of the camera.
    pub camera: String,
    /// The direction of view, if it is not the usual one.
    pub direction: Option<DVec3>,
    /// The direction that is up.
    pub up: DVec3,
}

/// A note about what a kind leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KindNote {
    /// The part that is left out.
    pub what: &'static str,
    /// How to change that by flags, and by keys.
    pub remedies: [&'static str; 2],
}

/// The keys that say what is drawn of data. If one is given, the kind does not say it.
const STRUCTURE: [&str; 7] = ["bonds", "elements", "leave_out", "opacity_by", "radius", "radius_by", "show"];

/// A colour that stands out from pale backgrounds, and that colour maps do not have at their ends.
const PLAIN: &str = "#4c86b8";

/// The changes of a style. Colours that show numbers would be wrong if they faded.
fn look(traits: &Traits, shows_numbers: bool) -> &'static str {
    match traits.kind {
        // Lines would be around holes.
        Kind::Scan => "studio.outline.width = 0\nbackground = \"#f3f4f6\"\n",
        // Windings that nearly touch would have lines between them.
        Kind::Curve => "studio.outline.width = 0\n",
        Kind::Molecules if !traits.has_cell => "",
        Kind::Coarse | Kind::Polymer | Kind::Liquid | Kind::Particles | Kind::Molecules if !shows_numbers => {
            "studio.depth_cue.strength = 0.2\n"
        }
        _ => "",
    }
}

/// A length with five digits.
fn written(length: f64) -> String {
    let digits = format!("{length:.4e}").parse::<f64>().unwrap_or(length);
    format!("{digits:?}")
}

/// A direction with six digits, so that it can be written.
fn rounded(direction: DVec3) -> DVec3 {
    (direction * 1e6).round() / 1e6 + 0.0
}

/// Returns true if a key gives colours.
fn is_colored(is_given: &impl Fn(&str) -> bool) -> bool {
    ["color", "color_by", "elements", "show"].iter().any(|key| is_given(key))
}

/// The keys of a camera that say in which direction it looks, and those that say where it is or what is up.
const VIEWS: [&str; 4] = ["view", "direction", "turn", "focus_on"];
const PLACES: [&str; 5] = ["eye", "look_at", "up", "camera_path", "stereo"];

impl KindSettings {
    /// The settings for data with these traits, without those that are given: `is_given` tells for a key, or the end of
    /// the key of a camera, whether it is. `camera` is the kind of the camera, if it is given.
    #[must_use]
    pub fn new(traits: &Traits, camera: Option<&str>, is_given: impl Fn(&str) -> bool) -> Self {
        let mut settings = Self::default();
        settings.shapes(traits, &is_given);
        settings.colors(traits, &is_given);
        if !["eye", "camera_path"].iter().any(|key| is_given(key)) {
            settings.focus(traits, &is_given);
        }
        settings.view = KindView::new(traits, camera, &is_given);
        settings
    }

    /// All settings but the style: keys of a scene file.
    #[must_use]
    pub fn text(&self) -> String {
        let view = self.view.as_ref().map(|KindView { camera, direction, up }| {
            let direction = direction.map(|direction| format!("direction = {:?}, ", direction.to_array()));
            format!("camera.{camera} = {{ {}up = {:?} }}\n", direction.unwrap_or_default(), up.to_array())
        });
        [self.data.as_str(), &self.look, &view.unwrap_or_default()].concat()
    }

    fn add(&mut self, text: &str) {
        self.data += text;
        self.data.push('\n');
    }

    fn shapes(&mut self, traits: &Traits, is_given: &impl Fn(&str) -> bool) {
        // The edges of a cell with an empty layer would leave the picture.
        if traits.has_cell && !is_given("box") && ![Kind::Biomolecule, Kind::Slab].contains(&traits.kind) {
            self.add("box = true");
        }
        // Without a scale, nobody sees how far points reach.
        let has_box = traits.are_points && traits.flat.is_none() && traits.bulk.is_none();
        if has_box && [Kind::Plain, Kind::Curve].contains(&traits.kind) && !traits.has_cell && !is_given("box") {
            self.add("box = true");
        }
        if traits.has_cell && traits.kind == Kind::Crystal && !is_given("replicate") {
            self.add("replicate = \"faces\"");
        }
        // Tables of elements may give colours alone, and other radii to some.
        let has_sizes = STRUCTURE.iter().any(|key| *key != "elements" && is_given(key));
        if traits.kind == Kind::Particles && traits.beads_lack[1] && !has_sizes {
            self.add(&format!("radius = {}", written(0.5 * traits.spacing)));
        }
        if STRUCTURE.iter().any(|key| is_given(key)) {
            let has_sticks = matches!(traits.kind, Kind::Slab | Kind::Crystal | Kind::Molecules | Kind::Polymer);
            // Other sizes and colours do not take away the sticks.
            if has_sticks && !["bonds", "show"].iter().any(|key| is_given(key)) {
                self.add("bonds = true");
            }
            return;
        }
        match traits.kind {
            Kind::Coarse => self.add("show = [{ as = \"trace\" }]"),
            Kind::Slab if traits.is_metal => {
                let radius = written(0.5 * traits.spacing);
                let touching = format!("{{ select = \"metal\", as = \"spacefill\", radius = {radius} }}");
                self.add(&format!("show = [{{ as = \"balls\", scale = 1.6 }}, {touching}]"));
            }
            // Beads nearly touch along a chain.
            Kind::Polymer => self.add("show = [{ as = \"balls\", scale = 1.5 }]"),
            Kind::Molecules if traits.has_cell => self.add("show = [{ as = \"balls\", scale = 1.3 }]"),
            Kind::Slab | Kind::Crystal | Kind::Molecules => self.add("show = [{ as = \"balls\" }]"),
            Kind::Liquid => self.add("show = [{ as = \"spacefill\", scale = 0.7 }]"),
            // Points at random places leave few holes in surfaces.
            Kind::Scan => self.add(&format!("radius = {}", written(2.0 * traits.spacing))),
            Kind::Plain if let Some(radius) = traits.seen_radius => self.add(&format!("radius = {}", written(radius))),
            Kind::Curve => {
                let radius = traits.seen_radius.map(written);
                let [own, of_tube] = ["radius = ", ", radius = "]
                    .map(|key| radius.as_ref().map_or_else(String::new, |radius| format!("{key}{radius}")));
                self.add(&format!("{own}\nshow = [{{ as = \"trace\"{of_tube} }}]"));
            }
            // Stars are points, as long as neighbours are pixels apart.
            Kind::Stars if !is_given("radius_scale") => self.add("radius_scale = 0.3"),
            Kind::Atoms => {
                let radius = written(0.5 * traits.spacing);
                self.add(&format!("show = [{{ as = \"spacefill\", radius = {radius} }}]"));
            }
            _ => {}
        }
        if traits.kind == Kind::Biomolecule {
            self.biomolecule(traits, is_given);
        }
    }

    /// Ligands by element, and no water. Who selects water wants to see it.
    fn biomolecule(&mut self, traits: &Traits, is_given: &impl Fn(&str) -> bool) {
        let ligands = "{ select = \"not (polymer or water)\", as = \"spacefill\", color = \"element\" }";
        let water = "{ select = \"water\", as = \"hidden\" }";
        let has_ligands = traits.has_ligands && traits.has_chains && !is_colored(is_given);
        // Without a rule for all, only the ligands would be drawn.
        let rules = ["{ as = \"spacefill\" }", ligands, water].into_iter();
        let hides_water = traits.has_water && !is_given("select");
        let rules = rules.zip([has_ligands, has_ligands, hides_water]);
        let rules: Vec<&str> = rules.filter(|(_, is)| *is).map(|(rule, _)| rule).collect();
        if !rules.is_empty() {
            self.add(&format!("show = [{}]", rules.join(", ")));
        }
        if hides_water {
            let remedies = ["--show spacefill draws all", "show=\"spacefill\" draws all"];
            self.notes.push(KindNote { what: "water is not drawn", remedies });
        }
    }

    fn colors(&mut self, traits: &Traits, is_given: &impl Fn(&str) -> bool) {
        if !["style", "integrator", "background"].iter().any(|key| is_given(key)) {
            self.style = match traits.kind {
                Kind::Stars => Some(Style::Stars),
                // Points have the colours of surfaces, and no light of their own.
                Kind::Scan => Some(Style::Flat),
                _ => None,
            };
        }
        if !["style", "integrator", "studio", "background"].iter().any(|key| is_given(key)) {
            self.look = look(traits, is_given("color_by")).to_owned();
        }
        let are_chains = matches!(traits.kind, Kind::Biomolecule | Kind::Coarse) && traits.has_chains;
        if are_chains && !is_colored(is_given) {
            self.add("color_by = \"chain\"");
        }
        if matches!(traits.kind, Kind::Particles | Kind::Polymer) && traits.beads_lack[0] && !is_colored(is_given) {
            self.add("color_by = \"species\"");
        }
        let is_plain = traits.kind == Kind::Plain && traits.is_uncolored;
        if traits.kind == Kind::Curve && traits.is_uncolored && !is_colored(is_given) && !is_given("material") {
            self.add("color_by = \"index\"");
        }
        if is_plain && !is_colored(is_given) && !is_given("material") {
            self.add(&format!("color = \"{PLAIN}\""));
        }
    }

    fn focus(&mut self, traits: &Traits, is_given: &impl Fn(&str) -> bool) {
        if traits.kind == Kind::Slab && !is_given("focus") && !is_given("box") {
            // The empty layer may be wider than the slab.
            self.add("focus = \"all\"");
            return;
        }
        let Some([low, high]) = traits.bulk.filter(|_| !is_given("focus")) else { return };
        let within = ["x", "y", "z"].iter().zip(low.to_array().into_iter().zip(high.to_array()));
        let within: Vec<String> =
            within.map(|(axis, (low, high))| format!("{} <= {axis} <= {}", written(low), written(high))).collect();
        self.add(&format!("focus = \"{}\"", within.join(" and ")));
        let remedies = ["--focus all frames them, too", "focus=\"all\" frames them, too"];
        self.notes.push(KindNote { what: "a few spheres far away are outside of the picture", remedies });
    }
}

impl KindView {
    /// The usual view of data with these traits, by a camera that frames it. `camera` is its kind, if that is given.
    fn new(traits: &Traits, camera: Option<&str>, is_given: &impl Fn(&str) -> bool) -> Option<Self> {
        let from = |azimuth: f64, elevation: f64| Viewpoint::Angles { azimuth, elevation }.axes(traits.up, 0.0);
        let is_placed = PLACES.iter().any(|key| is_given(key));
        let has_view = VIEWS.iter().any(|key| is_given(key));
        let (usual, direction, up) = match (traits.kind, traits.widest_view) {
            _ if is_placed => return None,
            (Kind::Plain | Kind::Curve, _) => match traits.flat.filter(|_| !has_view) {
                None => ("pinhole", None, DVec3::Z),
                // Straight on, with the first of its axes to the right.
                Some(2) => ("pinhole", Some(DVec3::NEG_Z), DVec3::Y),
                Some(1) => ("pinhole", Some(DVec3::Y), DVec3::Z),
                Some(_) => ("pinhole", Some(DVec3::NEG_X), DVec3::Z),
            },
            (Kind::Scan, _) if has_view => ("pinhole", None, traits.up),
            (Kind::Scan, _) => ("pinhole", Some(from(30.0, 35.0)[0]), traits.up),
            (Kind::Slab | Kind::Crystal, _) if has_view => ("orthographic", None, traits.up),
            (Kind::Slab, _) => ("orthographic", Some(from(15.0, 18.0)[0]), traits.up),
            (Kind::Crystal, _) => ("orthographic", Some(from(15.0, 10.0)[0]), traits.up),
            (Kind::Liquid | Kind::Atoms | Kind::Polymer | Kind::Particles, _) if traits.has_cell => {
                ("pinhole", None, DVec3::Z)
            }
            (Kind::Molecules | Kind::Biomolecule | Kind::Coarse, Some([eye, up])) if !has_view => {
                ("pinhole", Some(-eye), up)
            }
            _ => return None,
        };
        let known = keys_of("camera.orthographic");
        let has_lens = keys_of("camera.thin-lens").iter().any(|key| !known.contains(key) && is_given(key));
        let usual = if has_lens || is_given("stereo") { "pinhole" } else { usual };
        let camera = camera.unwrap_or(usual).to_owned();
        let can_frame = ["orthographic", "pinhole", "thin-lens"].contains(&camera.as_str());
        can_frame.then(|| Self { camera, direction: direction.map(rounded), up: rounded(up) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::SceneFile;

    fn traits(kind: Kind) -> Traits {
        Traits {
            kind,
            has_cell: true,
            spacing: 2.5,
            up: DVec3::new(0.0, 0.6, -0.8),
            is_metal: true,
            has_chains: true,
            has_water: true,
            has_ligands: true,
            beads_lack: [true; 2],
            widest_view: Some([DVec3::X, DVec3::Z]),
            bulk: Some([DVec3::splat(-1.0), DVec3::splat(2.5)]),
            is_uncolored: true,
            seen_radius: Some(0.1),
            are_points: true,
            flat: Some(1),
        }
    }

    #[test]
    fn all_settings_can_be_read() {
        for kind in Kind::ALL {
            for spacing in [3e-9, 2.5, 4e12] {
                let bulk = Some([DVec3::splat(-spacing), DVec3::new(spacing, 0.0, 1e-3 * spacing)]);
                let traits = Traits { is_metal: spacing > 3.0, spacing, bulk, ..traits(kind) };
                let settings = KindSettings::new(&traits, None, |_| false);
                let text = format!("data = \"a.xyz\"\n{}", settings.text());
                assert!(SceneFile::parse(&text).is_ok(), "{text}");
            }
        }
    }

    #[test]
    fn stars_and_scans_have_styles() {
        for (kind, style) in [(Kind::Stars, Style::Stars), (Kind::Scan, Style::Flat)] {
            assert_eq!(KindSettings::new(&traits(kind), None, |_| false).style, Some(style));
            for given in ["style", "integrator", "background"] {
                assert_eq!(KindSettings::new(&traits(kind), None, |key| key == given).style, None, "{given}");
            }
        }
    }

    #[test]
    fn plain_data_has_a_color_and_z_is_up() {
        let plain = |flat, given: &'static [&str]| {
            let traits = Traits { flat, bulk: None, has_cell: false, ..traits(Kind::Plain) };
            KindSettings::new(&traits, None, |key| given.contains(&key)).text()
        };
        let up = "camera.pinhole = { up = [0.0, 0.0, 1.0] }\n";
        assert_eq!(plain(None, &[]), format!("box = true\nradius = 0.1\ncolor = \"{PLAIN}\"\n{up}"));
        assert_eq!(plain(Some(2), &["view", "radius", "color_by"]), up);
        assert_eq!(plain(None, &["material", "radius_by", "up", "box"]), "");
        let across = ["0.0, 0.0, -1.0], up = [0.0, 1.0, 0.0", "0.0, 1.0, 0.0], up = [0.0, 0.0, 1.0"];
        for (axis, view) in [(2, across[0]), (1, across[1])] {
            assert!(plain(Some(axis), &[]).contains(view), "{axis}: {}", plain(Some(axis), &[]));
        }
    }

    #[test]
    fn what_is_given_stays() {
        let all = ["box", "replicate", "bonds", "background", "studio", "color", "view", "up", "select", "focus"];
        for kind in Kind::ALL {
            assert_eq!(KindSettings::new(&traits(kind), None, |key| all.contains(&key)).text(), "", "{kind:?}");
        }
        let slab = KindSettings::new(&traits(Kind::Slab), Some("pinhole"), |_| false);
        let view = slab.view.unwrap();
        assert_eq!((view.camera.as_str(), view.up), ("pinhole", DVec3::new(0.0, 0.6, -0.8)));
        let above = -view.direction.unwrap().dot(view.up);
        assert!((above - 18f64.to_radians().sin()).abs() < 1e-6, "{:?}", view.direction);
        let turned = KindSettings::new(&traits(Kind::Slab), None, |key| key == "view").view.unwrap();
        assert_eq!((turned.camera.as_str(), turned.direction), ("orthographic", None));
    }
}
