//! Renders a look of a scene: on the shared device, which keeps the scene between pictures, or on the CPU.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::Duration;

use crate::device::{self, Backend, OpenDevice};
use crate::fault::{Fault, Outcome};
use crate::look::Look;
use crate::worker::Stop;
use pinhole::accel::AccelChoice;
use pinhole::cpu::{self, RenderError, SearchPlan};
use pinhole::gpu::{GpuError, PictureRequest, RenderPlan, SceneBuffers, UploadProgress, Wait, with_retries};
use pinhole::render::{Integrator, Picture, Watch};
use pinhole::scene::SceneUpdate;
use pinhole::{Image, LayerSet, RenderSettings, Scene, View};

/// Time that a thread sleeps before it looks again whether another thread has rendered its picture.
const WAIT: Duration = Duration::from_millis(2);

struct DeviceScene {
    opened: Arc<OpenDevice>,
    buffers: SceneBuffers,
    for_light: Light,
    /// The number of updates that the scene had.
    version: u64,
}

/// The kind of settings for which a scene was copied, because structures differ.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Light {
    None,
    Studio,
    Path,
}

impl Light {
    fn of(settings: &RenderSettings) -> Self {
        match settings.integrator {
            Integrator::Studio(_) => Self::Studio,
            Integrator::Path(_) => Self::Path,
            _ => Self::None,
        }
    }
}

/// A scene on the device, if it was copied there. It is locked while a picture is rendered.
#[derive(Default)]
pub(crate) struct OnDevice {
    uploaded: Mutex<Option<DeviceScene>>,
}

/// A picture, with the name of its renderer.
pub(crate) struct RenderedImage {
    pub(crate) image: Image,
    /// The name of the adapter; `None` for the CPU.
    pub(crate) adapter: Option<String>,
    pub(crate) warning: Option<String>,
}

impl OnDevice {
    /// Renders the scene, on a new device if the shared one was lost.
    pub(crate) fn render(
        &self,
        (scene, version): (&Scene, u64),
        look: &Look,
        layers: LayerSet,
        backend: Backend,
        stop: &Stop,
    ) -> Outcome<RenderedImage> {
        let reason = |on: &Arc<OpenDevice>| on.headless.reason_for_cpu(scene, look.view().camera, &look.settings);
        let opened = device::device(backend)?.filter(|opened| backend != Backend::Auto || reason(opened).is_none());
        let Some(opened) = opened else {
            return on_cpu(scene, look, layers, stop);
        };
        match self.on_gpu(&opened, (scene, version), look, layers, stop) {
            Err(Fault::Lost(_)) => {
                device::forget(&opened);
                let Some(again) = device::device(backend)? else {
                    return on_cpu(scene, look, layers, stop);
                };
                self.on_gpu(&again, (scene, version), look, layers, stop)
            }
            done => done,
        }
    }

    /// Locks the scene on the device, as soon as no other thread renders it.
    fn wait(&self, stop: &Stop) -> Outcome<MutexGuard<'_, Option<DeviceScene>>> {
        loop {
            match self.uploaded.try_lock() {
                Ok(slot) => return Ok(slot),
                Err(TryLockError::Poisoned(slot)) => return Ok(slot.into_inner()),
                Err(TryLockError::WouldBlock) if stop.is_wanted() => return Err(Fault::Stopped),
                Err(TryLockError::WouldBlock) => thread::sleep(WAIT),
            }
        }
    }

    fn on_gpu(
        &self,
        opened: &Arc<OpenDevice>,
        (scene, version): (&Scene, u64),
        look: &Look,
        layers: LayerSet,
        stop: &Stop,
    ) -> Outcome<RenderedImage> {
        let (headless, light) = (&opened.headless, Light::of(&look.settings));
        let mut slot = self.wait(stop)?;
        let fits = |found: &DeviceScene| {
            Arc::ptr_eq(&found.opened, opened)
                && [Light::None, found.for_light].contains(&light)
                && found.version == version
        };
        let mut kept = slot.take().filter(fits);
        let views = look.views();
        let request = PictureRequest::new(scene, &look.view(), &look.settings, layers);
        let host_bytes_per_pixel = device::ENCODING_BYTES_PER_PIXEL;
        let request = PictureRequest { host_bytes_per_pixel, ..request };
        let plan = |choice| headless.plan(&request, choice);
        let work = |buffers: &SceneBuffers| {
            each(&views, stop, |view, watch| {
                headless.render_uploaded(buffers, view, &look.settings, layers, watch).wait()
            })
        };
        let known = match kept.as_ref().map(|kept| work(&kept.buffers)) {
            Some(Err(GpuError::Steps)) | None => None,
            Some(done) => Some(done),
        };
        let images = match known {
            Some(done) => done,
            None => {
                drop(kept);
                let copied = Mutex::new(None);
                let copy_and_work = |plan: &RenderPlan| {
                    plan.check(&headless.device().limits(), device::available())?;
                    let watch = &mut |_: &UploadProgress| stop.decision();
                    let buffers = headless.upload_planned(scene, &plan.structures(), watch).wait()?;
                    let images = work(&buffers)?;
                    *copied.lock().unwrap_or_else(PoisonError::into_inner) = Some(buffers);
                    Ok(images)
                };
                let attempt = async |plan: &RenderPlan| Ok::<_, GpuError>(copy_and_work(plan));
                let tried = with_retries(AccelChoice::Auto, plan, |_| {}, attempt).wait();
                let done = tried.and_then(|done| done);
                let copied = copied.into_inner().unwrap_or_else(PoisonError::into_inner);
                kept = copied.map(|buffers| DeviceScene {
                    opened: Arc::clone(opened),
                    buffers,
                    for_light: light,
                    version,
                });
                done
            }
        };
        // The next render may use the scene of a render that was stopped.
        *slot = kept;
        let images = images?;
        let adapter = Some(headless.adapter_info().name.clone());
        Ok(RenderedImage { image: joined(images)?, adapter, warning: opened.warning.clone() })
    }

    /// Applies an update of a scene to the copy on the device. A copy that cannot be updated is dropped, and made
    /// again when it is needed.
    pub(crate) fn update(&self, (scene, version): (&Scene, u64), update: &SceneUpdate<'_>) {
        let mut slot = self.uploaded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(uploaded) = slot.as_mut() {
            // The later of two simultaneous updates may come first.
            let is_next = uploaded.version + 1 == version;
            let DeviceScene { opened, buffers, .. } = uploaded;
            if is_next && opened.headless.update(buffers, scene, update).wait().is_ok() {
                uploaded.version = version;
            } else {
                *slot = None;
            }
        }
    }
}

fn on_cpu(scene: &Scene, look: &Look, layers: LayerSet, stop: &Stop) -> Outcome<RenderedImage> {
    let plan = SearchPlan::new(scene);
    device::check_on_cpu(&plan, look, layers)?;
    let structure = plan.build().map_err(Fault::input)?;
    let images =
        each(&look.views(), stop, |view, watch| cpu::render_watched(&structure, view, &look.settings, layers, watch));
    let images = images.map_err(|error| match error {
        RenderError::Stopped => Fault::Stopped,
        error => Fault::input(error),
    })?;
    Ok(RenderedImage { image: joined(images)?, adapter: None, warning: None })
}

/// Renders each view, and reports the progress of all views together.
fn each<E>(
    views: &[View<'_>],
    stop: &Stop,
    render: impl Fn(&View<'_>, &mut Watch<'_>) -> Result<Picture, E>,
) -> Result<Vec<Image>, E> {
    let pictures = views.iter().enumerate().map(|(done, view)| {
        let picture = render(view, &mut |progress| {
            stop.report((done as f64 + progress.part) / views.len() as f64);
            stop.decision()
        });
        Ok(picture?.image)
    });
    pictures.collect()
}

/// The picture, or those of two eyes side by side.
fn joined(mut images: Vec<Image>) -> Outcome<Image> {
    match (images.pop(), images.pop()) {
        (Some(right), Some(left)) => Image::side_by_side([&left, &right]).map_err(Fault::input),
        (Some(image), None) => Ok(image),
        _ => Err(Fault::Internal("there is no picture".to_owned())),
    }
}
