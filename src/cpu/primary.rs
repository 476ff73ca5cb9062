//! Pictures with one ray per pixel. The WGSL twins are `shaders/primary/trace.wgsl` and `shaders/primary/shade.wgsl`.

use std::ops::Range;

use super::pace::{Pace, RenderError};
use super::search::Search;
use super::sphere;
use crate::camera::View;
use crate::geometry::cone_crossing;
use crate::geometry::math::wide;
use crate::geometry::ray::{Hit, Ray};
use crate::image::{Image, LayerSet, Pixel, RowMut};
use crate::parallel::for_each;
use crate::render::{Decision, Picture, PrimarySettings, Progress, Shading, Watch};
use crate::scene::{Scene, Shape};

/// The nearest hit in front of the ray's origin. If several shapes are equally near, the one with the smallest id.
/// `None` for a miss. If `search` is a reference to a scene, every shape is tested.
#[must_use]
pub fn trace<'a>(search: impl Into<Search<'a>>, ray_in_world: &Ray) -> Option<Hit> {
    let search = search.into();
    let ray = Ray { origin: ray_in_world.origin - search.scene().origin(), ..*ray_in_world };
    let test = |shape: Shape| match shape {
        Shape::Sphere([x, y, z, radius]) => sphere::intersect(&ray, wide([x, y, z]), radius.into()),
        Shape::Cone(cone) => cone_crossing::intersect(&ray, &cone),
    };
    let nearest = search.nearest(&ray, |shape| test(shape).map(|(t, _)| t))?;
    let (t, normal) = test(nearest.shape)?;
    Some(Hit { t, id: nearest.id, normal })
}

/// The pixel of a primary ray that hits a shape.
#[must_use]
pub fn shade(scene: &Scene, primary: &PrimarySettings, ray: &Ray, hit: &Hit) -> Pixel {
    let surface = scene.color(hit.id).to_array();
    let color = match primary.shading {
        Shading::Flat => surface,
        Shading::Headlight => {
            let cosine = hit.normal.dot(ray.direction).abs();
            surface.map(|c| (f64::from(c) * cosine) as f32)
        }
    };
    Pixel {
        color,
        depth: hit.t as f32,
        normal: hit.normal.as_vec3().to_array(),
        position: ray.at(hit.t).as_vec3().to_array(),
        albedo: surface,
        id: hit.id,
    }
}

/// The pixel that the ray through its centre gives.
pub(super) fn primary_pixel(search: Search<'_>, view: &View<'_>, primary: &PrimarySettings, pixel: [u32; 2]) -> Pixel {
    let ray = view.ray_through_center(pixel);
    let hit = ray.as_ref().and_then(|ray| trace(search, ray));
    match (&ray, &hit) {
        (Some(ray), Some(hit)) => shade(search.scene(), primary, ray, hit),
        _ => Pixel::miss(primary.background.to_array()),
    }
}

/// Calls `work` with each pixel (column and row) of some rows, its index in its row, and the row, on all cores.
pub(super) fn for_rows(image: &mut Image, rows: Range<usize>, work: impl Fn([u32; 2], usize, &mut RowMut<'_>) + Sync) {
    let (width, start) = (image.width(), rows.start);
    for_each(image.rows_mut(rows).into_iter().enumerate().collect(), |(j, mut row)| {
        for i in 0..width {
            work([i, (start + j) as u32], i as usize, &mut row);
        }
    });
}

/// Renders a picture of primary rays. Calls `watch` after some rows to ask how to continue.
pub(super) fn primary_watched(
    search: Search<'_>,
    view: &View<'_>,
    primary: &PrimarySettings,
    layers: LayerSet,
    watch: &mut Watch<'_>,
) -> Result<Picture, RenderError> {
    let mut image = Image::new(view.film.width(), view.film.height(), layers)?;
    let height = image.height() as usize;
    Pace::new().run(height, |rows| {
        let is_done = rows.end == height;
        let part = rows.end as f64 / height as f64;
        for_rows(&mut image, rows, |pixel, i, row| {
            row.set(i, &primary_pixel(search, view, primary, pixel));
        });
        match watch(&Progress { samples: is_done.into(), total: 1, part, noise: None }) {
            Decision::GoOn | Decision::MeasureNoise => Ok(()),
            Decision::Finish if is_done => Ok(()),
            Decision::Finish | Decision::Stop => Err(RenderError::Stopped),
        }
    })?;
    Ok(Picture::by_primary_rays(image))
}
