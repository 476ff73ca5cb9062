//! Settings for each kind of data: shapes, colours and a view, if nobody says so.

use pinhole::glam::DVec3;
use pinhole_data::kind::{Kind, Traits};

/// Settings for a kind of data.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KindSettings {
    /// The settings: keys of a scene file.
    pub text: String,
    /// Notes for the user about what is not drawn.
    pub notes: Vec<&'static str>,
}

/// The keys that say what is drawn of data. If one is given, the kind does not say it.
const STRUCTURE: [&str; 8] =
    ["bonds", "elements", "leave_out", "opacity_by", "radius", "radius_by", "radius_scale", "show"];

/// A length with five digits.
fn written(length: f64) -> String {
    let digits = format!("{length:.4e}").parse::<f64>().unwrap_or(length);
    format!("{digits:?}")
}

/// A direction with six digits.
fn direction(direction: DVec3) -> String {
    direction.to_array().map(|part| format!("{:?}", (part * 1e6).round() / 1e6 + 0.0)).join(", ")
}

/// Returns true if a key gives colours.
fn is_colored(is_given: &impl Fn(&str) -> bool) -> bool {
    ["color", "color_by", "elements", "show"].iter().any(|key| is_given(key))
}

/// The keys of a camera that say from where it looks.
const VIEWS: [&str; 9] = ["view", "eye", "look_at", "direction", "up", "turn", "focus_on", "camera_path", "stereo"];

impl KindSettings {
    /// The settings for data with these traits, without those that are given: `is_given` tells for a key, or the end of
    /// the key of a camera, whether it is. `camera` is the kind of the camera, if it is given.
    #[must_use]
    pub fn new(traits: &Traits, camera: Option<&str>, is_given: impl Fn(&str) -> bool) -> Self {
        let mut settings = Self::default();
        settings.shapes(traits, &is_given);
        settings.colors(traits, &is_given);
        settings.view(traits, camera, &is_given);
        settings
    }

    fn add(&mut self, text: &str) {
        self.text += text;
        self.text.push('\n');
    }

    fn shapes(&mut self, traits: &Traits, is_given: &impl Fn(&str) -> bool) {
        if traits.has_cell && !is_given("box") && traits.kind != Kind::Biomolecule {
            self.add("box = true");
        }
        if traits.kind == Kind::Crystal && traits.has_cell && !is_given("replicate") {
            self.add("replicate = \"faces\"");
        }
        if STRUCTURE.iter().any(|key| is_given(key)) {
            return;
        }
        match traits.kind {
            Kind::Coarse => self.add("show = [{ as = \"trace\" }]"),
            Kind::Slab if traits.is_metal => {
                let radius = written(0.5 * traits.spacing);
                let touching = format!("{{ select = \"metal\", as = \"spacefill\", radius = {radius} }}");
                self.add(&format!("show = [{{ as = \"balls\" }}, {touching}]"));
            }
            Kind::Slab | Kind::Crystal | Kind::Molecules => self.add("show = [{ as = \"balls\" }]"),
            Kind::Liquid => self.add("show = [{ as = \"spacefill\", scale = 0.7 }]"),
            Kind::Atoms => {
                let radius = written(0.5 * traits.spacing);
                self.add(&format!("show = [{{ as = \"spacefill\", radius = {radius} }}]"));
            }
            _ => {}
        }
        if traits.kind == Kind::Biomolecule {
            self.biomolecule(traits, is_given);
        }
        if traits.kind == Kind::Particles && traits.has_beads {
            self.add(&format!("radius = {}", written(0.5 * traits.spacing)));
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
            self.notes.push("water is not drawn; --show spacefill draws all");
        }
    }

    fn colors(&mut self, traits: &Traits, is_given: &impl Fn(&str) -> bool) {
        if traits.kind == Kind::Stars && !is_given("background") && !is_given("color") && !is_given("color_by") {
            self.add("background = \"black\"\ncolor = \"white\"");
        }
        let are_chains = matches!(traits.kind, Kind::Biomolecule | Kind::Coarse) && traits.has_chains;
        if are_chains && !is_colored(is_given) {
            self.add("color_by = \"chain\"");
        }
        if traits.kind == Kind::Particles && traits.has_beads && !is_colored(is_given) {
            self.add("color_by = \"species\"");
        }
    }

    fn view(&mut self, traits: &Traits, camera: Option<&str>, is_given: &impl Fn(&str) -> bool) {
        if VIEWS.iter().any(|key| is_given(key)) {
            return;
        }
        if let Some([low, high]) = traits.bulk.filter(|_| !is_given("focus")) {
            let within = ["x", "y", "z"].iter().zip(low.to_array().into_iter().zip(high.to_array()));
            let within: Vec<String> =
                within.map(|(axis, (low, high))| format!("{} <= {axis} <= {}", written(low), written(high))).collect();
            self.add(&format!("focus = \"{}\"", within.join(" and ")));
            self.notes.push("a few spheres far away are outside of the picture; --focus all frames them, too");
        }
        let (from, up, usual) = match (traits.kind, traits.widest_view) {
            (Kind::Slab, _) => ("view = \"0,8\"".to_owned(), traits.up, "orthographic"),
            (Kind::Crystal, _) => ("view = \"15,10\"".to_owned(), traits.up, "orthographic"),
            (Kind::Molecules | Kind::Biomolecule | Kind::Coarse, Some([eye, up])) => {
                (format!("direction = [{}]", direction(-eye)), up, "pinhole")
            }
            _ => return,
        };
        let (up, kind) = (direction(up), camera.unwrap_or(usual));
        if !["orthographic", "pinhole", "thin-lens"].contains(&kind) {
            return;
        }
        self.add(&format!("camera.{kind} = {{ {from}, up = [{up}] }}"));
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
            has_beads: true,
            widest_view: Some([DVec3::X, DVec3::Z]),
            bulk: Some([DVec3::splat(-1.0), DVec3::splat(2.5)]),
        }
    }

    #[test]
    fn all_settings_can_be_read() {
        for kind in Kind::ALL {
            for spacing in [3e-9, 2.5, 4e12] {
                let bulk = Some([DVec3::splat(-spacing), DVec3::new(spacing, 0.0, 1e-3 * spacing)]);
                let traits = Traits { is_metal: spacing > 3.0, spacing, bulk, ..traits(kind) };
                let settings = KindSettings::new(&traits, None, |_| false);
                let text = format!("data = \"a.xyz\"\n{}", settings.text);
                assert!(SceneFile::parse(&text).is_ok(), "{text}");
            }
        }
    }

    #[test]
    fn what_is_given_stays() {
        let all = ["box", "replicate", "bonds", "background", "color", "view", "select"];
        for kind in Kind::ALL {
            assert_eq!(KindSettings::new(&traits(kind), None, |key| all.contains(&key)).text, "", "{kind:?}");
        }
        let slab = KindSettings::new(&traits(Kind::Slab), Some("pinhole"), |_| false);
        assert!(slab.text.contains("camera.pinhole = { view = \"0,8\", up = [0.0, 0.6, -0.8] }"), "{}", slab.text);
    }
}
