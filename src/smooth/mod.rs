//! Smooth pictures: studios in which nothing is random.
//!
//! Such a picture follows from the shapes that rays through the centres of pixels hit, which a device or the reference
//! finds. A pixel is an *edge* if one of its eight neighbours shows another shape, or the normal of a cone turns much within
//! it, as at a rim. It then has rays at some fixed places, which are the same for all pixels; each may hit the shapes that
//! the pixel and its neighbours show. Every shape in a pixel is lit once, where it is hit on average. Ambient light is dimmed by [`Openness`]. In a
//! [dense](crate::render::Studio::is_dense) picture, all pixels have rays, whose ids are found as those of a larger film.
//!
//! So a picture depends only on shapes, view, settings and ids, and does not depend on
//! the device that found them.
//!
//! If [light adds up](crate::render::Studio::added_light), spheres have the light of [`added::AddedLight`] and no spots.

use glam::DVec3;

use crate::camera::{Camera, View};
use crate::image::{Averages, Image, ImageTooLarge, Layer, LayerSet, outline};
#[cfg(feature = "gpu")]
use crate::light::LightKind;
use crate::parallel;
use crate::render::{Decision, Picture, Progress, RenderSettings, Watch};
use crate::scene::{Scene, SceneAppearance, SharedShapes};
use added::Stars;
#[cfg(feature = "gpu")]
use cells::Cells;
#[cfg(feature = "gpu")]
use levels::Levels;
use lit::Lit;
use spots::{Finder, Rays, Row, Spot};
use tables::Tables;

mod added;
mod caps;
mod cells;
mod lamps;
mod levels;
mod lists;
mod lit;
mod openness;
mod pieces;
mod spots;
mod tables;

/// The number of pixels that are drawn together, which bounds the memory for [`Spot`]s.
const BAND: usize = 1 << 21;

/// Returns what [`RenderSettings::is_smooth`] does, for spheres with this appearance.
fn is_smooth(settings: &RenderSettings, appearance: &SceneAppearance, camera: &dyn Camera) -> bool {
    let studio = settings.studio_parameters();
    // Nothing is random in light that adds up.
    studio.is_some_and(|studio| studio.added_light)
        || studio.is_some_and(|studio| studio.is_smooth) && !camera.has_lens() && !settings.has_chance(appearance)
}

impl RenderSettings {
    /// Returns true if nothing is random in the picture: a [smooth](crate::render::Studio::is_smooth) studio is asked for, no
    /// noise is to be removed, all spheres are opaque and have no gloss, there is no ground and no lens, and lights are at
    /// the eye, or infinitely far away with an angular radius of at most 15°. Such a picture follows from the spheres that rays through the
    /// centres of pixels hit. So is a studio with [added light](crate::render::Studio::added_light), which follows from all
    /// spheres.
    #[must_use]
    pub fn is_smooth(&self, scene: &Scene, camera: &dyn Camera) -> bool {
        is_smooth(self, scene.checked_appearance(), camera)
    }

    /// Returns true if light is sampled at random: the picture has lighting, and is not [smooth](Self::is_smooth).
    #[must_use]
    pub fn is_random(&self, scene: &Scene, camera: &dyn Camera) -> bool {
        !self.integrator.is_primary() && !self.is_smooth(scene, camera)
    }
}

/// A smooth picture, before it is drawn.
#[derive(Clone, Copy)]
pub(crate) struct SmoothPicture<'a> {
    shapes: &'a SharedShapes,
    appearance: &'a SceneAppearance,
    /// Origin of the spheres' frame, in world space.
    origin: DVec3,
    view: View<'a>,
    rays: Rays,
    settings: &'a RenderSettings,
}

impl<'a> SmoothPicture<'a> {
    /// `None` if the picture is not smooth.
    pub(crate) fn new(
        (shapes, origin): (&'a SharedShapes, DVec3),
        appearance: &'a SceneAppearance,
        view: &View<'a>,
        settings: &'a RenderSettings,
    ) -> Option<Self> {
        let rays = Rays::new(&view.film, settings);
        let picture = Self { shapes, appearance, origin, view: *view, rays, settings };
        is_smooth(settings, appearance, view.camera).then_some(picture)
    }

    /// The picture of a scene; `None` if it is not smooth.
    pub(crate) fn of(scene: &'a Scene, view: &View<'a>, settings: &'a RenderSettings) -> Option<Self> {
        Self::new((scene.shared_shapes(), scene.origin()), scene.checked_appearance(), view, settings)
    }

    /// The view of the ids from which the picture follows: for a part of a film, with the pixels around it, and with a pixel
    /// for every ray of a dense picture.
    pub(crate) fn view_of_ids(&self) -> View<'a> {
        View { film: self.rays.film, ..self.view }
    }

    /// The places in [`Self::view_of_ids`] of the ids from which a pixel follows, the ray through its centre in the middle.
    /// `None` for those outside, which show what the middle shows.
    pub(crate) fn places(&self, pixel: [u32; 2]) -> Vec<Option<[u32; 2]>> {
        (0..self.rays.ids()).map(|at| self.rays.place(pixel, at)).collect()
    }

    /// The bytes of the host's memory for drawing, about.
    #[cfg(feature = "gpu")]
    pub(crate) fn bytes(&self) -> u64 {
        let pixels = self.view.film.pixel_count();
        let side = u64::from(self.rays.side);
        // A ray makes at most one spot, and a pixel at an edge several.
        let spots = (pixels * (side * side).max(2)).min(2 * BAND as u64) * size_of::<Spot>() as u64;
        let cells = Cells::new(self.shapes);
        let shadows = self.settings.studio_parameters().is_some_and(|studio| studio.shadows);
        let is_lamp = |kind| shadows && matches!(kind, LightKind::Directional { .. });
        let lamps = self.settings.lights.iter().filter(|light| is_lamp(light.kind)).count();
        let added = if self.has_added_light() { added::AddedLight::bytes(&self.view.film) } else { 0 };
        spots
            + added
            + Levels::bytes(&cells, self.shapes.len())
            + openness::Openness::bytes(&cells, pixels)
            + lamps as u64 * lamps::Lamp::bytes(&cells, pixels)
    }

    /// The layers of the picture of ids from which a picture with these layers follows, and whether it is shaded.
    pub(crate) fn layers(&self, wanted: LayerSet) -> (LayerSet, bool) {
        let layers: LayerSet = self.settings.layers_for(wanted).iter().chain([Layer::Id]).collect();
        (layers, layers.contains(Layer::Normal))
    }

    /// Draws the picture from that of its ids, by primary rays, with the layers of [`Self::layers`]. The error is `stopped`
    /// if `watch` stops the work.
    pub(crate) fn draw<E: From<ImageTooLarge>>(
        &self,
        ids: Image,
        layers: LayerSet,
        stopped: E,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, E> {
        let (film, rays) = (&self.view.film, &self.rays);
        let total = rays.count;
        let mut progress = Progress { samples: 0, total, part: 0.5, noise: None };
        let mut go_on = |part: f64| {
            progress.part = 0.5 + 0.5 * part;
            watch(&progress) != Decision::Stop
        };
        let shown = ids.id().unwrap_or_default().to_vec();
        let mut image = match rays.place([0; 2], rays.ids() / 2) {
            Some(first) if *film != rays.film => ids.cut(first, [film.width(), film.height()], rays.side)?,
            _ => ids,
        };
        let Some((opacity, crowded)) = self.draw_from(&shown, &mut image, &mut go_on) else { return Err(stopped) };
        if let Some(lines) = self.settings.studio_parameters().and_then(|studio| studio.outline) {
            outline::draw(&mut image, &lines);
        }
        image.keep(layers);
        Ok(Picture { image, samples: total, noise: None, hits: Some(opacity * f64::from(total)), crowded })
    }

    /// The light of some pixels, given with the ids of their [places](Self::places).
    pub(crate) fn pixels(&self, pixels: &[([u32; 2], Vec<u32>)]) -> Vec<Averages> {
        let mut tables = self.tables();
        let Some((finder, mut lit)) = self.tools(&mut tables) else { return Vec::new() };
        let added = self.has_added_light().then(|| self.stars().light(|| true)).flatten();
        let spots = parallel::map(pixels.len(), |at| {
            let (pixel, ids) = &pixels[at];
            let mut found = Row::default();
            finder.pixel(*pixel, ids, &mut found);
            self.leave_out_stars(found)
        });
        lit.see(&spots);
        let averages = parallel::map(pixels.len(), |at| {
            let light = added.as_ref().map(|added| added.of(self.view.film.in_whole(pixels[at].0)));
            self.averages(&lit, &spots[at].all, light)
        });
        self.shapes.keep(tables);
        averages
    }

    fn has_added_light(&self) -> bool {
        self.settings.studio_parameters().is_some_and(|studio| studio.added_light)
    }

    /// The spheres whose light adds up.
    fn stars(&self) -> Stars<'a> {
        let Self { shapes, appearance, origin, view, .. } = *self;
        Stars { spheres: &shapes.spheres, origin, appearance, view }
    }

    /// The spots of a row of pixels.
    fn row(&self, finder: &Finder<'_>, ids: &[u32], row: u32) -> Row {
        if self.has_added_light() && self.shapes.cones.is_empty() {
            return Row { all: Vec::new(), counts: vec![0; self.view.film.width() as usize] };
        }
        self.leave_out_stars(finder.row(ids, row))
    }

    /// Leaves out the spots of spheres whose light adds up.
    fn leave_out_stars(&self, mut row: Row) -> Row {
        if self.has_added_light() {
            let mut left = row.all.iter();
            for count in &mut row.counts {
                let of_pixel = left.by_ref().take((*count).into());
                *count = of_pixel.filter(|spot| self.is_cone(spot)).count() as u8;
            }
            row.all.retain(|spot| self.is_cone(spot));
        }
        row
    }

    fn is_cone(&self, spot: &Spot) -> bool {
        spot.id as usize >= self.shapes.spheres.len()
    }

    /// The tables of an earlier picture of the same spheres, or new ones.
    fn tables(&self) -> Tables {
        Tables::take(self.shapes, self.settings.studio_parameters())
    }

    /// The tools of drawing: they find spots, and light them.
    fn tools<'b>(&'b self, tables: &'b mut Tables) -> Option<(Finder<'a>, Lit<'b>)> {
        let finder = Finder::new(self.shapes, self.origin, &self.view, self.rays, self.settings);
        Some((finder, Lit::new(self.appearance, self.view.camera, self.settings, tables, self.shapes)?))
    }

    /// Writes colour, opacity, albedo and samples of all pixels. `go_on` learns the completed part several times, and stops
    /// the work by false. Returns the sum of all opacities, and `Picture::crowded`.
    fn draw_from(&self, ids: &[u32], image: &mut Image, mut go_on: impl FnMut(f64) -> bool) -> Option<(f64, usize)> {
        let mut tables = self.tables();
        let (finder, mut lit) = self.tools(&mut tables)?;
        let added = match self.has_added_light() {
            true => Some(self.stars().light(|| go_on(0.0))?),
            false => None,
        };
        let [width, height] = [image.width(), image.height()].map(|side| side as usize);
        let mut opacity = 0.0;
        let side = self.rays.side as usize;
        for rows in parallel::ranges(height, (BAND / (width * side * side)).max(1)) {
            let spots = parallel::map(rows.len(), |row| self.row(&finder, ids, (rows.start + row) as u32));
            lit.see(&spots);
            if !go_on((rows.start + rows.len() / 2) as f64 / height as f64) {
                return None;
            }
            let parts = spots.iter().zip(image.rows_mut(rows.clone())).zip(rows.clone()).collect();
            let sums = parallel::map_parts(parts, |((row, mut to), number)| {
                let mut left = &row.all[..];
                let mut opacity = 0.0;
                for (column, count) in row.counts.iter().enumerate() {
                    let (spots, others) = left.split_at(usize::from(*count));
                    left = others;
                    let pixel = self.view.film.in_whole([column as u32, number as u32]);
                    let averages = self.averages(&lit, spots, added.as_ref().map(|added| added.of(pixel)));
                    opacity += f64::from(averages.alpha);
                    to.set_averages(column, &averages);
                }
                opacity
            });
            opacity += sums.into_iter().sum::<f64>();
            if !go_on(rows.end as f64 / height as f64) {
                return None;
            }
        }
        let crowded = lit.crowded();
        self.shapes.keep(tables);
        Some((opacity, crowded))
    }

    /// The averages over the spots of a pixel, with light that adds up.
    fn averages(&self, lit: &Lit<'_>, spots: &[Spot], added: Option<DVec3>) -> Averages {
        let (mut color, mut albedo, mut alpha) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for spot in spots {
            let share = f64::from(spot.share);
            color += share * lit.color(spot);
            albedo += share * lit.albedo(spot.id).min(DVec3::ONE);
            alpha += share;
        }
        color += (1.0 - alpha) * lit.background;
        if let Some(added) = added {
            color += added;
            albedo += added;
            alpha += (1.0 - alpha) * added.max_element();
        }
        let [color, albedo] = [color, albedo].map(|color| color.as_vec3().to_array());
        Averages { color, alpha: alpha as f32, albedo, samples: self.rays.count, variance: 0.0 }
    }
}

/// Tells a caller of the first half of the work, finding ids. It cannot finish early.
pub(crate) fn first_half(watch: &mut Watch<'_>) -> impl FnMut(&Progress) -> Decision {
    |progress| match watch(&Progress { samples: 0, part: 0.5 * progress.part, ..*progress }) {
        Decision::Stop => Decision::Stop,
        _ => Decision::GoOn,
    }
}
