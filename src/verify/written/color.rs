//! The colours that a conforming device may find for a pixel.

use glam::DVec3;

use crate::camera::View;
use crate::render::PrimarySettings;
use crate::verify::camera::{AnyRay, CameraModel};
use crate::verify::certificate::Verdict;
use crate::verify::checker::Checker;
use crate::verify::hit::LegalHits;
use crate::verify::recording::{RequestedCamera, UploadedView};
use crate::verify::rounding::{Interval, PAD, U};
use crate::verify::shading::{LegalNormals, exactly, legal_color_near};

/// Legal colours: those of one side of a sphere, or that of a miss.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegalColor {
    /// Linear red, green and blue.
    pub(super) color: [Interval; 3],
    pub(super) is_hit: bool,
}

/// The data with which pixels are judged.
pub(super) struct PictureCheck<'a> {
    checker: &'a Checker<'a>,
    model: CameraModel,
    primary: &'a PrimarySettings,
    /// The distance between rays that start at different places along the axis, because their origins are rounded.
    moved: f64,
}

impl<'a> PictureCheck<'a> {
    pub(super) fn new(
        checker: &'a Checker<'a>,
        view: &View<'_>,
        primary: &'a PrimarySettings,
    ) -> Self {
        let requested = RequestedCamera::of(view.camera);
        let uploaded =
            UploadedView::expected(&requested, checker.scene.origin(), checker.candidates.bounds());
        let origin = DVec3::from(uploaded.origin.map(f64::from)).length();
        let [min, max] =
            [uploaded.scene_min, uploaded.scene_max].map(|v| DVec3::from(v.map(f64::from)));
        let model = CameraModel::new(requested.kind, &uploaded, &view.film);
        // A device may choose another start by as much as the box is large.
        let moved = 2.0 * U * (origin + (max - min).length());
        Self { checker, model, primary, moved }
    }

    /// Finds the legal colours of a pixel. The verdict says whether there is a single legal answer.
    pub(super) fn legal(
        &self,
        pixel: [u32; 2],
        hits: &mut LegalHits,
        colors: &mut Vec<LegalColor>,
    ) -> Verdict {
        hits.clear();
        colors.clear();
        if !self.checker.scene.is_empty() {
            self.find(pixel, hits, colors);
        }
        if hits.miss {
            let color = self.primary.background.to_array().map(exactly);
            colors.push(LegalColor { color, is_hit: false });
        }
        match (hits.count(), hits.miss) {
            (1, _) => Verdict::Decided,
            (_, true) => Verdict::Silhouette,
            (_, false) => Verdict::Tie,
        }
    }

    /// Finds the spheres that may be hit, and their colours.
    fn find(&self, pixel: [u32; 2], hits: &mut LegalHits, colors: &mut Vec<LegalColor>) {
        let mut ray = self.model.ray(pixel).any(&self.model);
        ray.slack.across += PAD * self.moved;
        ray.slack.along += PAD * self.moved;
        if ray.may_hit_box {
            hits.find_nearer(&self.checker.candidates, &ray.line, ray.slack, |_| false);
            hits.miss |= ray.may_miss_box;
        }
        for hit in &hits.spheres {
            self.add_colors(&ray, hit.id, colors);
        }
    }

    fn add_colors(&self, ray: &AnyRay, id: u32, colors: &mut Vec<LegalColor>) {
        let scene = self.checker.scene;
        let normals = LegalNormals::new(&ray.line, scene.spheres()[id as usize], ray.slack);
        let own = scene.color(id).to_array();
        colors.extend(normals.crossings().map(|normal| LegalColor {
            color: legal_color_near(self.primary.shading, own, normal, ray.direction),
            is_hit: true,
        }));
    }
}
