//! Quick pictures on the window's own device, recorded into the window's encoder. Studios have their light; others
//! have primary rays.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use eframe::{egui, wgpu};

use crate::blit::Blit;
use crate::worker::QuickScene;
use pinhole::camera::film::Film;
use pinhole::camera::{Camera, View};
use pinhole::gpu::{Frame, LitState, LivePicture, PickedPixel, Picker, TargetTextures, Wait};
use pinhole::render::{Integrator, RenderSettings};

/// The time that a picture may take while the camera moves. Slower pictures get fewer pixels.
const MOVING: Duration = Duration::from_millis(55);

/// The sides of pictures while the camera moves, as fractions of the whole.
const PARTS: [f64; 4] = [1.0, 0.7, 0.5, 0.33];

/// The quick picture of the window, shared with the callback in which egui records it.
#[derive(Clone)]
pub(crate) struct Quick(Arc<Mutex<State>>);

struct State {
    render: RenderState,
    blit: Blit,
    scene: Option<QuickScene>,
    targets: Option<TargetSet>,
    camera: Option<Box<dyn Camera>>,
    picker: Option<Picker>,
    is_due: bool,
    /// A pixel of the picture to pick.
    pick: Option<[u32; 2]>,
    is_picking: bool,
    /// The microseconds that the last picture took; 0 while the device is working.
    taken: Arc<AtomicU64>,
    /// Index in [`PARTS`] of the picture's size.
    part: usize,
    /// The times of pictures of each size: by primary rays, and live.
    times: [Times; 2],
    pictures: u64,
    error: Option<String>,
}

/// Textures of one size, and the objects that render into them.
struct TargetSet {
    textures: TargetTextures,
    source: Source,
    /// The bind group for drawing the colours.
    group: wgpu::BindGroup,
}

/// The object that renders a quick picture.
enum Source {
    /// One ray for each pixel, lit from the eye.
    Primary(Box<Frame>),
    /// The light of a studio.
    Live(Box<LivePicture>),
}

/// The time of pictures of each size, which is measured while the camera moves.
#[derive(Debug, Default)]
struct Times([Option<Duration>; PARTS.len()]);

impl Times {
    fn learn(&mut self, part: usize, taken: Duration) {
        // Other work may delay a single picture, but not several in a row.
        let time = &mut self.0[part];
        *time = Some(time.map_or(taken, |before| before.mul_f64(0.7) + taken.mul_f64(0.3)));
    }

    /// Index of the largest size that is quick enough. If none is, it is the largest that is not much slower than the
    /// smallest, because some work does not depend on the number of pixels.
    fn part(&self) -> usize {
        // Sizes without a measurement are tried.
        let is_quick = |time: &Option<Duration>| time.is_none_or(|time| time <= MOVING);
        if let Some(part) = self.0.iter().position(is_quick) {
            return part;
        }
        let least = self.0.iter().flatten().min().copied().unwrap_or_default();
        let is_near = |time: &Option<Duration>| time.is_some_and(|time| time <= least.mul_f64(1.25));
        self.0.iter().position(is_near).unwrap_or(0)
    }

    /// Whether even the smallest pictures take too long.
    fn is_slow(&self) -> bool {
        self.0.iter().all(|time| time.is_some_and(|time| time > 2 * MOVING))
    }
}

/// A view to render.
pub(crate) struct Sight {
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) settings: RenderSettings,
    /// The size of the whole picture in pixels.
    pub(crate) size: [u32; 2],
    /// Whether fewer pixels are enough.
    pub(crate) is_moving: bool,
}

impl Quick {
    pub(crate) fn new(render: RenderState) -> Self {
        let (picker, error) = match Picker::new(&render.device, 3).wait() {
            Ok(picker) => (Some(picker), None),
            Err(error) => (None, Some(error.to_string())),
        };
        let device = render.device.clone();
        let quick = Self(Arc::new(Mutex::new(State {
            blit: Blit::new(&render),
            render,
            scene: None,
            targets: None,
            camera: None,
            picker,
            is_due: false,
            pick: None,
            is_picking: false,
            taken: Arc::default(),
            part: 0,
            times: Default::default(),
            pictures: 0,
            error,
        })));
        // Unexpected errors are shown, and do not end the program.
        let weak = Arc::downgrade(&quick.0);
        device.on_uncaptured_error(Arc::new(move |error| {
            let message = error.to_string();
            let Some(state) = weak.upgrade() else { return };
            // The code that caused the error may hold the lock of the state.
            let _ = std::thread::Builder::new().spawn(move || {
                state.lock().unwrap_or_else(PoisonError::into_inner).error = Some(message);
            });
        }));
        quick
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Replaces the scene.
    pub(crate) fn set_scene(&self, scene: QuickScene) {
        let mut state = self.state();
        // A frame is bound to its renderer.
        let is_same = |old: &QuickScene| Arc::ptr_eq(&old.renderer, &scene.renderer);
        if !state.scene.as_ref().is_some_and(is_same) {
            state.targets = None;
        }
        state.scene = Some(scene);
    }

    /// Checks without waiting which work the device has finished.
    pub(crate) fn poll(&self) {
        let mut state = self.state();
        let _ = state.render.device.poll(wgpu::PollType::Poll);
        let taken = state.taken.swap(0, Ordering::AcqRel);
        if taken > 0 {
            let (part, kind) = (state.part, usize::from(state.is_live()));
            state.times[kind].learn(part, Duration::from_micros(taken));
        }
    }

    /// Prepares a picture, which the next frame of the window renders.
    pub(crate) fn see(&self, sight: Sight) {
        let mut state = self.state();
        if let Err(error) = state.see(sight) {
            state.error = Some(error);
        }
    }

    /// Requests the sphere at a pixel of the picture, given by fractions of its width and height.
    pub(crate) fn pick(&self, [x, y]: [f64; 2]) {
        let mut state = self.state();
        let Some(size) = state.targets.as_ref().map(|targets| targets.textures.size()) else {
            return;
        };
        let pixel = |part: f64, side: u32| ((part * f64::from(side)) as u32).min(side - 1);
        state.pick = Some([pixel(x, size[0]), pixel(y, size[1])]);
    }

    /// Whether a picture or a pick waits for the device.
    pub(crate) fn is_waiting(&self) -> bool {
        let state = self.state();
        state.is_due || state.pick.is_some() || state.is_picking
    }

    pub(crate) fn picked(&self) -> Option<PickedPixel> {
        let mut state = self.state();
        match state.picker.as_mut()?.take() {
            Ok(None) => None,
            Ok(Some(picked)) => {
                state.is_picking = false;
                Some(picked)
            }
            Err(error) => {
                (state.is_picking, state.error) = (false, Some(error.to_string()));
                None
            }
        }
    }

    /// The last error since the previous call, if there was one.
    pub(crate) fn take_error(&self) -> Option<String> {
        self.state().error.take()
    }

    pub(crate) fn size(&self) -> Option<[u32; 2]> {
        self.state().targets.as_ref().map(|targets| targets.textures.size())
    }

    pub(crate) fn count(&self) -> u64 {
        self.state().pictures
    }

    /// Makes the callback for egui's own frame. If `is_seen`, it draws the picture into the rectangle.
    pub(crate) fn callback(&self, rect: egui::Rect, is_seen: bool) -> egui::epaint::PaintCallback {
        let recording = Recording { quick: self.clone(), is_seen };
        eframe::egui_wgpu::Callback::new_paint_callback(rect, recording)
    }
}

impl State {
    fn is_live(&self) -> bool {
        self.targets.as_ref().is_some_and(|targets| matches!(targets.source, Source::Live(_)))
    }

    fn see(&mut self, sight: Sight) -> Result<(), String> {
        let Some(scene) = self.scene.clone() else { return Ok(()) };
        let is_studio = matches!(sight.settings.integrator, Integrator::Studio(_));
        let is_live = scene.is_live && is_studio && !self.times[1].is_slow();
        if is_live && self.see_with(&scene, &sight, true).is_err() {
            // A scene that cannot be shown with its light is shown without it.
            if let Some(scene) = &mut self.scene {
                scene.is_live = false;
            }
        }
        if !self.scene.as_ref().is_some_and(|scene| scene.is_live) || !is_live {
            self.see_with(&scene, &sight, false).map_err(|error| error.to_string())?;
        }
        (self.camera, self.is_due) = (Some(sight.camera), true);
        Ok(())
    }

    fn see_with(&mut self, scene: &QuickScene, sight: &Sight, is_live: bool) -> Result<(), Box<dyn std::error::Error>> {
        let part = if sight.is_moving { self.times[usize::from(is_live)].part() } else { 0 };
        let size = sight.size.map(|side| ((f64::from(side) * PARTS[part]).round() as u32).max(1));
        let film = Film::new(size[0], size[1])?;
        let view = View::new(sight.camera.as_ref(), film);
        let background = sight.settings.visible_background();
        let background = background.unwrap_or(sight.settings.background);
        let settings = match is_live {
            true => RenderSettings { is_transparent: false, ..sight.settings.clone() },
            false => RenderSettings { background, ..RenderSettings::default() },
        };
        let RenderState { device, queue, .. } = &self.render;
        let (renderer, buffers) = (&scene.renderer, &scene.buffers);
        let fits = |targets: &TargetSet| {
            targets.textures.size() == size && matches!(targets.source, Source::Live(_)) == is_live
        };
        if !self.targets.as_ref().is_some_and(fits) {
            let textures = TargetTextures::new(renderer.renderer(), device, size).wait()?;
            let targets = textures.targets();
            let source = match is_live {
                true => {
                    let live = LivePicture::new(renderer, device, queue, buffers, &view, &settings, &targets).wait();
                    Source::Live(Box::new(live?))
                }
                false => {
                    let frame = Frame::new(renderer.renderer(), device, &targets).wait()?;
                    Source::Primary(Box::new(frame))
                }
            };
            let group = self.blit.group(device, targets.color);
            self.targets = Some(TargetSet { textures, source, group });
        }
        match self.targets.as_mut().map(|targets| &mut targets.source) {
            Some(Source::Live(live)) => {
                live.set(renderer, device, queue, buffers, &view, &settings).wait()?;
            }
            Some(Source::Primary(frame)) => frame.set_view(queue, buffers, &view, &settings)?,
            None => {}
        }
        self.part = part;
        Ok(())
    }

    fn record(&mut self, encoder: &mut wgpu::CommandEncoder) -> Result<(), String> {
        let (Some(scene), Some(targets), Some(camera)) = (&self.scene, &mut self.targets, &self.camera) else {
            return Ok(());
        };
        if self.is_due {
            let recorded = match &mut targets.source {
                Source::Primary(frame) => {
                    scene.renderer.renderer().record(encoder, &scene.buffers, frame).map(|()| true)
                }
                Source::Live(live) => {
                    let queue = &self.render.queue;
                    let recorded = live.record(&scene.renderer, queue, encoder, &scene.buffers);
                    recorded.map(|progress| progress.state != LitState::Waiting)
                }
            };
            match recorded {
                Ok(true) => self.is_due = false,
                // The device is still busy.
                Ok(false) => return Ok(()),
                Err(error) => {
                    self.is_due = false;
                    return Err(error.to_string());
                }
            }
            self.pictures += 1;
            let (started, taken) = (Instant::now(), Arc::clone(&self.taken));
            encoder.on_submitted_work_done(move || {
                let micros = u64::try_from(started.elapsed().as_micros()).unwrap_or(u64::MAX);
                taken.store(micros.max(1), Ordering::Release);
            });
        }
        if let (Some(pixel), Some(picker)) = (self.pick.take(), &mut self.picker) {
            let [width, height] = targets.textures.size();
            let film = Film::new(width, height).map_err(|error| error.to_string())?;
            let view = View::new(camera.as_ref(), film);
            let recorded = picker.record(encoder, &targets.textures.targets(), &view, pixel);
            recorded.map_err(|error| error.to_string())?;
            self.is_picking = true;
        }
        Ok(())
    }
}

struct Recording {
    quick: Quick,
    is_seen: bool,
}

impl CallbackTrait for Recording {
    fn prepare(
        &self,
        _: &wgpu::Device,
        _: &wgpu::Queue,
        _: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        _: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let mut state = self.quick.state();
        if let Err(error) = state.record(encoder) {
            state.error = Some(error);
        }
        Vec::new()
    }

    fn paint(&self, _: egui::PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _: &CallbackResources) {
        let state = self.quick.state();
        if let Some(targets) = state.targets.as_ref().filter(|_| self.is_seen) {
            state.blit.draw(pass, &targets.group);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(millis: [u64; 4]) -> Times {
        Times(millis.map(|millis| Some(Duration::from_millis(millis))))
    }

    #[test]
    fn pictures_are_as_large_as_they_are_quick() {
        assert_eq!(Times::default().part(), 0);
        assert_eq!(times([50, 30, 20, 10]).part(), 0);
        assert_eq!(times([300, 150, 54, 40]).part(), 2);
        assert_eq!(times([900, 400, 200, 110]).part(), 3);
        // Fewer pixels would not help here.
        assert_eq!(times([120, 110, 105, 100]).part(), 0);
        let mut slow = Times::default();
        slow.learn(0, Duration::from_millis(200));
        assert_eq!(slow.part(), 1);
        (0..20).for_each(|_| slow.learn(0, Duration::from_millis(20)));
        assert_eq!(slow.part(), 0);
    }
}
