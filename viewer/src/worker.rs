//! Threads besides the window's: one reads files and renders stills, others save pictures.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use eframe::egui;
use pinhole_cli::viewing::{Facts, OpenView, RenderFlags, StillPicture, StillRenderer, ViewError};

use pinhole::accel::Structure;
use pinhole::camera::film::Film;
use pinhole::camera::{CameraKind, View};
use pinhole::gpu::{
    GpuError, LitRenderer, LivePicture, Renderer, RendererOptions, SceneBuffers, TargetTextures, Wait, wgpu,
};
use pinhole::render::{Integrator, RenderSettings};

/// A request of the window.
#[derive(Clone, Debug)]
pub(crate) struct Request {
    /// The number of the window's state for this request.
    pub(crate) state: u64,
    pub(crate) flags: RenderFlags,
    /// Whether still pictures are wanted.
    pub(crate) still: bool,
}

pub(crate) enum Message {
    /// The flags of a request were understood, and the file was read.
    Shown(Box<News>),
    /// A still picture, which will be followed by better ones.
    Still {
        state: u64,
        picture: StillPicture,
    },
    /// A request failed. The window keeps its contents.
    Failed {
        state: u64,
        error: ViewError,
    },
    Note(String),
}

/// The result of reading the flags and the file of a request.
pub(crate) struct News {
    pub(crate) state: u64,
    pub(crate) facts: Facts,
    /// The scene on the window's device, if there is a window.
    pub(crate) quick: Option<QuickScene>,
}

/// A scene on the window's device, and its renderer there.
#[derive(Clone)]
pub(crate) struct QuickScene {
    pub(crate) renderer: Arc<LitRenderer>,
    pub(crate) buffers: Arc<SceneBuffers>,
    /// Whether the scene is lit as a studio, which the window's device can render in motion.
    pub(crate) is_live: bool,
}

/// The parts of the window that this thread needs.
#[derive(Clone)]
pub(crate) struct Window {
    pub(crate) context: egui::Context,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

#[derive(Default)]
struct Inbox {
    request: Option<Request>,
    window: Option<Window>,
    is_closed: bool,
}

#[derive(Default)]
struct WorkerState {
    inbox: Mutex<Inbox>,
    is_changed: Condvar,
    /// The number of requests so far, so that work for an older one can end.
    newest: AtomicU64,
}

impl WorkerState {
    fn inbox(&self) -> MutexGuard<'_, Inbox> {
        self.inbox.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The thread, and the channels to and from it.
pub(crate) struct Worker {
    shared: Arc<WorkerState>,
    messages: Receiver<Message>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    pub(crate) fn start(request: Request) -> std::io::Result<Self> {
        let shared = Arc::new(WorkerState::default());
        shared.inbox().request = Some(request);
        let (sender, messages) = channel();
        let thread = std::thread::Builder::new().name("pictures".to_owned()).spawn({
            let shared = Arc::clone(&shared);
            move || {
                let (shown, still, renderer, buffers) = (None, None, None, None);
                Work { shared, sender, shown, still, renderer, buffers }.run();
            }
        })?;
        Ok(Self { shared, messages, thread: Some(thread) })
    }

    /// Gives the thread the window's device.
    pub(crate) fn attach(&self, window: Window) {
        self.shared.inbox().window = Some(window);
        self.shared.is_changed.notify_all();
    }

    /// Sends a request, which replaces earlier ones.
    pub(crate) fn ask(&self, request: Request) {
        let mut inbox = self.shared.inbox();
        // The thread reads the number with the request.
        self.cancel();
        inbox.request = Some(request);
        drop(inbox);
        self.shared.is_changed.notify_all();
    }

    /// Stops the still picture in progress.
    pub(crate) fn cancel(&self) {
        self.shared.newest.fetch_add(1, Ordering::AcqRel);
    }

    pub(crate) fn message(&self) -> Option<Message> {
        self.messages.try_recv().ok()
    }

    /// Returns the next message, if there is one within a time.
    pub(crate) fn message_within(&self, time: Duration) -> Option<Message> {
        self.messages.recv_timeout(time).ok()
    }

    /// Ends the thread, so that no driver is interrupted. It does not wait for a file that takes long to read.
    pub(crate) fn close(&mut self) {
        self.shared.inbox().is_closed = true;
        self.cancel();
        self.shared.is_changed.notify_all();
        let Some(thread) = self.thread.take() else { return };
        for _ in 0..300 {
            if thread.is_finished() {
                let _ = thread.join();
                return;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

struct Work {
    shared: Arc<WorkerState>,
    sender: Sender<Message>,
    shown: Option<OpenView>,
    still: Option<StillRenderer>,
    /// The renderer of quick pictures, for a kind of camera, with pipelines for cones or without.
    renderer: Option<(CameraKind, bool, Arc<LitRenderer>)>,
    /// The current scene on the window's device.
    buffers: Option<Arc<SceneBuffers>>,
}

impl Work {
    fn run(mut self) {
        while let Some((request, number)) = self.next() {
            let state = request.state;
            match self.show(&request, number) {
                Ok(()) => {}
                Err(error) => self.tell(Message::Failed { state, error }),
            }
        }
    }

    /// Waits for a request, or for a window that shows the last one.
    fn next(&self) -> Option<(Request, u64)> {
        let mut inbox = self.shared.inbox();
        loop {
            if inbox.is_closed {
                return None;
            }
            if let Some(request) = inbox.request.take() {
                return Some((request, self.shared.newest.load(Ordering::Acquire)));
            }
            inbox = self.shared.is_changed.wait(inbox).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn window(&self) -> Option<Window> {
        self.shared.inbox().window.clone()
    }

    fn tell(&self, message: Message) {
        // A closed window needs no messages.
        let _ = self.sender.send(message);
        if let Some(window) = self.window() {
            window.context.request_repaint();
        }
    }

    fn show(&mut self, request: &Request, number: u64) -> Result<(), ViewError> {
        let flags = &request.flags;
        let reopened = match &mut self.shown {
            Some(shown) if flags.has_data_of(shown.flags()) => {
                shown.see(flags)?;
                None
            }
            before => Some(OpenView::open(flags, before.as_ref())?),
        };
        if let Some(shown) = reopened {
            self.buffers = None;
            self.shown = Some(shown);
        }
        let window = self.window();
        let quick = window.as_ref().map(|window| self.prepared(window)).transpose();
        let quick = quick.map_err(|error| error_of(&error))?.flatten();
        let Some(shown) = &self.shown else { return Ok(()) };
        let facts = shown.facts();
        self.tell(Message::Shown(Box::new(News { state: request.state, facts, quick })));
        if !request.still || window.is_none() {
            return Ok(());
        }
        if self.still.is_none() {
            let still = StillRenderer::open(flags)?;
            if let Some(warning) = still.warning() {
                self.tell(Message::Note(warning.to_owned()));
            }
            self.still = Some(still);
        }
        let (sender, shared) = (self.sender.clone(), Arc::clone(&self.shared));
        let (Some(still), Some(shown)) = (&mut self.still, &self.shown) else { return Ok(()) };
        let is_wanted = move || shared.newest.load(Ordering::Acquire) == number;
        still.render(shown, &is_wanted, &mut |picture| {
            let _ = sender.send(Message::Still { state: request.state, picture });
            if let Some(window) = &window {
                window.context.request_repaint();
            }
        })?;
        Ok(())
    }

    /// Makes the renderer of quick pictures, and copies the scene to the window's device, unless both exist.
    fn prepared(&mut self, window: &Window) -> Result<Option<QuickScene>, GpuError> {
        let Window { device, queue, .. } = window;
        let Some(shown) = &self.shown else { return Ok(None) };
        let camera = shown.camera().kind();
        let has_cones = !shown.scene().cones().is_empty();
        let before = self.renderer.take().filter(|(kind, of_cones, _)| (*kind, *of_cones) == (camera, has_cones));
        let renderer = match before {
            Some((.., renderer)) => renderer,
            None => {
                let cameras = vec![camera];
                let cone_structures = if has_cones { Structure::ALL.to_vec() } else { Vec::new() };
                let options =
                    RendererOptions { data_layers: true, cameras, cone_structures, ..RendererOptions::default() };
                Arc::new(LitRenderer::new(Renderer::new(device, &options).wait()?))
            }
        };
        self.renderer = Some((camera, has_cones, Arc::clone(&renderer)));
        let buffers = match self.buffers.take() {
            Some(buffers) => buffers,
            None => Arc::new(SceneBuffers::new(renderer.renderer(), device, queue, shown.scene()).wait()?),
        };
        self.buffers = Some(Arc::clone(&buffers));
        let is_live = is_live(window, &renderer, &buffers, shown);
        Ok(Some(QuickScene { renderer, buffers, is_live }))
    }
}

/// Whether a live picture of the scene is possible. Builds its pipelines, so that the window does not wait for them.
fn is_live(
    Window { device, queue, .. }: &Window,
    renderer: &LitRenderer,
    scene: &SceneBuffers,
    shown: &OpenView,
) -> bool {
    if !matches!(shown.settings().integrator, Integrator::Studio(_)) {
        return false;
    }
    let Ok(film) = Film::new(16, 16) else { return false };
    let view = View::new(shown.camera(), film);
    let settings = RenderSettings { is_transparent: false, ..shown.settings().clone() };
    let layers = TargetTextures::new(renderer.renderer(), device, [16, 16]).wait();
    let Ok(layers) = layers else { return false };
    LivePicture::new(renderer, device, queue, scene, &view, &settings, &layers.targets()).wait().is_ok()
}

fn error_of(error: &GpuError) -> ViewError {
    ViewError::new(format!("the window's device: {error}"))
}

/// A picture that is being written.
pub(crate) struct Saving {
    pub(crate) output: String,
    pub(crate) started: Instant,
    result: Receiver<Result<(), ViewError>>,
}

impl Saving {
    pub(crate) fn start(flags: RenderFlags, output: String, context: egui::Context) -> std::io::Result<Self> {
        let (sender, result) = channel();
        std::thread::Builder::new().name("saving".to_owned()).spawn({
            let output = output.clone();
            move || {
                let _ = sender.send(flags.save(&output));
                context.request_repaint();
            }
        })?;
        Ok(Self { output, started: Instant::now(), result })
    }

    /// The result of saving, once it is known.
    pub(crate) fn result(&self) -> Option<Result<(), ViewError>> {
        use std::sync::mpsc::TryRecvError;
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                Some(Err(ViewError::new(format!("{}: saving ended without a result", self.output))))
            }
        }
    }
}
