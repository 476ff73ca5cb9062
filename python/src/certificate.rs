//! The check of whether a device rendered correctly.

use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use crate::device::{self, Backend};
use crate::fault::{Fault, Outcome};
use crate::look::Look;
use crate::worker::Stop;
use pinhole::Scene;
use pinhole::accel::AccelChoice;
use pinhole::gpu::{GpuError, Progress, RenderPlan, UploadProgress, Wait, with_retries};
use pinhole::verify::{Certificate, Checker, Verdict};

/// The result of the checker.
#[pyclass(frozen, name = "Judged", module = "pinhole._pinhole")]
pub(crate) struct CertificateData {
    certificate: Certificate,
    /// The name of the adapter that rendered.
    #[pyo3(get)]
    adapter: String,
}

#[pymethods]
impl CertificateData {
    /// The outcome: proved, undecided or violated.
    #[getter]
    fn outcome(&self) -> &'static str {
        self.certificate.outcome().name()
    }

    /// Returns true if the outcome is proved: every pixel is legal, and at most 1 % have other legal answers.
    #[getter]
    fn is_legal(&self) -> bool {
        self.certificate.is_legal()
    }

    /// The number of pixels with each verdict.
    fn counts(&self) -> Vec<(&'static str, usize)> {
        Verdict::ALL.iter().map(|v| (v.name(), self.certificate.count(*v))).collect()
    }

    /// The verdict about every pixel, as an index into `counts`: uint8 of shape (height, width).
    fn verdicts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        let place = |of: &Verdict| Verdict::ALL.iter().position(|v| v == of).unwrap_or(0) as u8;
        let all: Vec<u8> = self.certificate.verdicts.iter().map(place).collect();
        let [width, height] = self.certificate.size.map(|side| side as usize);
        let height = if all.is_empty() { 0 } else { height };
        all.into_pyarray(py).reshape([height, width])
    }

    /// The first violations, in words.
    fn violations(&self) -> Vec<String> {
        let upload = self.certificate.upload.iter().map(ToString::to_string);
        upload.chain(self.certificate.violations.iter().map(ToString::to_string)).collect()
    }

    fn __str__(&self) -> String {
        self.certificate.to_string()
    }
}

/// Renders a view with one ray for each pixel, records it, and judges it.
pub(crate) fn verified(scene: &Scene, look: &Look, stop: &Stop) -> Outcome<CertificateData> {
    let Some(opened) = device::device(Backend::Gpu)? else {
        return Err(Fault::Device(GpuError::NoAdapter.to_string()));
    };
    let (headless, view) = (&opened.headless, look.view());
    let settings = look.settings.by_primary_rays();
    let plan = |choice| headless.plan_record(scene, &view, choice, 0);
    let record = |plan: &RenderPlan| {
        plan.check(&headless.device().limits(), device::available())?;
        let watch = &mut |_: &UploadProgress| stop.decision();
        let buffers = headless.upload_planned(scene, &plan.structures(), watch).wait()?;
        headless.record_and_render(&buffers, &view, &settings, &mut |_: &Progress| stop.decision()).wait()
    };
    let record = async |plan: &RenderPlan| Ok::<_, GpuError>(record(plan));
    let mut recording = with_retries(AccelChoice::Auto, plan, |_| {}, record).wait()??;
    let watch = &mut |_: &Progress| stop.decision();
    headless.compare_single(&mut recording, scene, &view, &settings, watch).wait()?;
    let checker = Checker::new(scene).map_err(Fault::input)?;
    let certificate = checker.certify(&recording);
    Ok(CertificateData { certificate, adapter: headless.adapter_info().name.clone() })
}
