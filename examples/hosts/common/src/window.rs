//! A window whose contents a host draws.

use std::marker::PhantomData;
use std::sync::Arc;

use pinhole::gpu::wgpu;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop, OwnedDisplayHandle};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

use crate::{Gpu, Orbit, Outcome, WindowSurface};

/// A program that draws in a window.
pub trait Host: Sized {
    /// The title of the window.
    const TITLE: &'static str;

    /// Whether the surface takes linear light and encodes it.
    const IS_SRGB: bool = true;

    /// Creates the objects that depend on the device.
    fn new(gpu: &Gpu, size: [u32; 2], orbit: &Orbit) -> Outcome<Self>;

    /// Creates the objects that depend on the size of the window.
    fn resize(&mut self, gpu: &Gpu, size: [u32; 2], orbit: &Orbit) -> Outcome<()>;

    /// Draws the window. Returns whether it must be drawn again without an event.
    fn draw(&mut self, gpu: &Gpu, orbit: &Orbit, window: &wgpu::Texture) -> Outcome<Next>;

    /// Handles a key, given as the character that it types.
    fn key(&mut self, key: &str, orbit: &Orbit) -> Outcome<()>;
}

/// The time at which a host draws its window again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// At once.
    Draw,
    /// After the next event.
    Wait,
}

/// Opens a window and runs a host in it until Escape is pressed or the window is closed. Dragging turns the camera, and
/// the wheel moves it.
pub fn run<H: Host>() -> Outcome<()> {
    crate::start_log();
    let events = EventLoop::new()?;
    let mut program: Program<H> = Program {
        display: events.owned_display_handle(),
        open: None,
        orbit: Orbit::default(),
        cursor: [0.0; 2],
        is_dragging: false,
        failed: None,
        host: PhantomData,
    };
    events.run_app(&mut program)?;
    program.failed.map_or(Ok(()), Err)
}

struct Program<H> {
    display: OwnedDisplayHandle,
    open: Option<Open<H>>,
    orbit: Orbit,
    cursor: [f64; 2],
    is_dragging: bool,
    failed: Option<Box<dyn std::error::Error>>,
    host: PhantomData<H>,
}

/// The state while the window is open. The surface is dropped before the window.
struct Open<H> {
    host: H,
    gpu: Gpu,
    surface: WindowSurface,
    window: Arc<Window>,
}

impl<H: Host> Open<H> {
    fn new(events: &ActiveEventLoop, display: OwnedDisplayHandle, orbit: &Orbit) -> Outcome<Self> {
        let attributes = Window::default_attributes().with_title(H::TITLE).with_inner_size(PhysicalSize::new(800, 600));
        let window = Arc::new(events.create_window(attributes)?);
        let (surface, gpu) = pollster::block_on(WindowSurface::open(Arc::clone(&window), display, H::IS_SRGB))?;
        let host = H::new(&gpu, surface.size(), orbit)?;
        Ok(Self { host, gpu, surface, window })
    }

    fn draw(&mut self, orbit: &Orbit) -> Outcome<()> {
        let Some(texture) = self.surface.next_texture(&self.gpu)? else { return Ok(()) };
        let next = self.host.draw(&self.gpu, orbit, &texture.texture)?;
        self.window.pre_present_notify();
        self.gpu.queue.present(texture);
        if next == Next::Draw {
            self.window.request_redraw();
        }
        Ok(())
    }
}

impl<H: Host> Program<H> {
    fn handle(&mut self, events: &ActiveEventLoop, event: &WindowEvent) -> Outcome<()> {
        let Some(open) = &mut self.open else { return Ok(()) };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested => return open.draw(&self.orbit),
            WindowEvent::Resized(size) => {
                open.surface.resize(&open.gpu, [size.width, size.height]);
                open.host.resize(&open.gpu, open.surface.size(), &self.orbit)?;
            }
            WindowEvent::Occluded(is_occluded) if !is_occluded => {}
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.is_dragging = *state == ElementState::Pressed;
                return Ok(());
            }
            WindowEvent::CursorMoved { position, .. } => {
                let before = std::mem::replace(&mut self.cursor, [position.x, position.y]);
                if !self.is_dragging {
                    return Ok(());
                }
                self.orbit.drag([position.x - before[0], position.y - before[1]]);
            }
            WindowEvent::MouseWheel { delta, .. } => self.orbit.zoom(match delta {
                MouseScrollDelta::LineDelta(_, lines) => f64::from(*lines),
                MouseScrollDelta::PixelDelta(pixels) => pixels.y / 40.0,
            }),
            WindowEvent::KeyboardInput { event, .. } if event.state.is_pressed() => match &event.logical_key {
                Key::Named(NamedKey::Escape) => events.exit(),
                Key::Named(NamedKey::Space) => open.host.key(" ", &self.orbit)?,
                Key::Character(key) => open.host.key(key, &self.orbit)?,
                _ => return Ok(()),
            },
            _ => return Ok(()),
        }
        open.window.request_redraw();
        Ok(())
    }
}

impl<H: Host> ApplicationHandler for Program<H> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match Open::new(events, self.display.clone(), &self.orbit) {
            Ok(open) => self.open = Some(open),
            Err(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Err(error) = self.handle(events, &event) {
            self.fail(events, error);
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // The surface must not outlive its connection to the display.
        self.open = None;
    }
}

impl<H> Program<H> {
    fn fail(&mut self, events: &ActiveEventLoop, error: Box<dyn std::error::Error>) {
        self.failed = Some(error);
        events.exit();
    }
}
