//! Spheres in Python: a checked scene, and its copy on a device.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{self, Centers, ColorArray};
use crate::certificate::{self, CertificateData};
use crate::cones;
use crate::device::Backend;
use crate::fault::{Fault, Outcome, in_python};
use crate::image::Picture;
use crate::look::{self, Look, SceneText};
use crate::render::OnDevice;
use crate::scene::{DataExtras, kind_of, scene_of};
use crate::worker;
use pinhole::camera::Viewpoint;
use pinhole::glam::DVec3;
use pinhole::image::Layer;
use pinhole::scene::{Centers as NewCenters, NewColors, SceneUpdate};
use pinhole::{LayerSet, Scene};
use pinhole_data::added::ArrowKey;
use pinhole_data::kind::Traits;
use pinhole_data::load::{Column, Dataset};
use pinhole_data::replicate::Replicate;
use pinhole_figure::color_by::ColorKey;
use pinhole_figure::framing::swept;
use pinhole_figure::kind::{KindSettings, KindView};
use pinhole_figure::scene_file::{Data, DataScene};
use pinhole_figure::style::Style;

/// Spheres: arrays or a file, and the settings that concern data.
#[pyclass(frozen, module = "pinhole._pinhole")]
pub(crate) struct SphereData {
    /// The scene, which updates replace or change.
    scene: Mutex<Arc<Scene>>,
    /// The meaning of colours, if a column gives them.
    pub(crate) key: Option<ColorKey>,
    pub(crate) arrow_key: Option<ArrowKey>,
    /// The loaded data, if they contain more than the scene.
    pub(crate) loaded: Option<Arc<Dataset>>,
    /// How the data is repeated, and the columns of the spheres in the picture if these are others than those of the
    /// data.
    pub(crate) replicate: Option<Replicate>,
    pub(crate) shown: Option<Vec<Column>>,
    /// The traits by which its kind was chosen, and the settings that follow.
    pub(crate) traits: Option<Traits>,
    kind: KindSettings,
    /// Is true if the caller gave radii, and the next if a colour to each sphere.
    pub(crate) has_radii: bool,
    pub(crate) is_colored: bool,
    /// Whether there are bonds, arrows or rules for what is drawn, which do not follow spheres that move.
    has_sticks: bool,
    pub(crate) z_is_up: bool,
    /// Notes for the user.
    #[pyo3(get)]
    notes: Vec<String>,
    pub(crate) on_device: OnDevice,
    /// The number of updates since the scene was made from loaded data. It changes while the scene is locked.
    updates: AtomicU64,
}

/// A camera, a direction of view, the direction that is up, and that of another view.
type ViewOfData = (String, Option<[f64; 3]>, [f64; 3], Option<[f64; 3]>);

/// The name of a kind, settings about data, the style, the view, and changes of the style.
type KindOfData = (Option<&'static str>, String, Option<&'static str>, Option<ViewOfData>, String);

impl SphereData {
    /// Makes spheres from loaded data.
    pub(crate) fn of_loaded(loaded: Dataset, text: &SceneText, given: DataExtras, z_is_up: bool) -> Outcome<Self> {
        let has_more = !loaded.columns.is_empty() || loaded.cell.is_some();
        let kept = has_more.then(|| Arc::new(loaded.clone()));
        let (has_radii, is_colored) = (given.radii, given.is_colored || given.colors.is_some());
        let found = given.colors.is_none().then(|| kind_of(&loaded, text, &given)).transpose()?;
        let (traits, kind) = found.map_or_else(Default::default, |(traits, kind)| (Some(traits), kind));
        let text = &text.with_kind(&kind);
        let (scene, columns, key, arrow_key, mut notes, bonds) = match given.colors {
            // Such colours need no list of distinct colours, which takes long to make.
            Some(colors) => {
                let scene = Scene::from_parts(loaded.spheres, colors.into());
                (scene.map_err(Fault::input)?, Vec::new(), None, None, loaded.notes, None)
            }
            None => {
                let DataScene { scene, columns, color_key, arrow_key, notes, bonds, .. } =
                    scene_of(loaded, text, given)?;
                (scene, columns, color_key, arrow_key, notes, bonds)
            }
        };
        notes.iter_mut().for_each(|note| *note = in_python(note));
        notes.extend(kind.notes.iter().map(|note| format!("{}; {}", note.what, note.remedies[1])));
        let file = text.parse()?;
        let has_rules = file.data().is_some_and(|data| !data.shows.is_empty());
        let replicate = file.data().and_then(|data| data.replicate);
        let is_part = |data: &Data| data.select.is_some() || data.replicate.is_some() || !data.leave_out.is_empty();
        let shown = (has_rules || file.data().is_some_and(is_part)).then_some(columns);
        let has_sticks = bonds.is_some_and(|bonds| bonds > 0) || arrow_key.is_some() || has_rules;
        Ok(Self {
            key,
            arrow_key,
            loaded: kept,
            replicate,
            shown,
            traits,
            kind,
            has_radii,
            is_colored,
            has_sticks,
            z_is_up,
            notes,
            ..Self::of_scene(scene)
        })
    }

    /// A scene without columns and notes.
    fn of_scene(scene: Scene) -> Self {
        Self {
            scene: Mutex::new(Arc::new(scene)),
            key: None,
            arrow_key: None,
            loaded: None,
            replicate: None,
            shown: None,
            traits: None,
            kind: KindSettings::default(),
            has_radii: true,
            is_colored: false,
            has_sticks: false,
            z_is_up: false,
            notes: Vec::new(),
            on_device: OnDevice::default(),
            updates: AtomicU64::new(0),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Arc<Scene>> {
        self.scene.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn scene(&self) -> Arc<Scene> {
        Arc::clone(&self.lock())
    }

    /// The current scene, and the number of its updates.
    fn versioned(&self) -> (Arc<Scene>, u64) {
        let scene = self.lock();
        (Arc::clone(&scene), self.updates.load(Ordering::Acquire))
    }

    /// The columns of the spheres in the picture.
    pub(crate) fn columns(&self) -> &[Column] {
        let of_data = self.loaded.as_ref().map_or(&[][..], |loaded| &loaded.columns);
        self.shown.as_deref().unwrap_or(of_data)
    }

    /// The number of spheres of the data in the picture.
    pub(crate) fn count(&self) -> usize {
        let scene = self.lock();
        scene.len() - scene.added()
    }

    /// Returns true if spheres were moved or changed.
    pub(crate) fn is_updated(&self) -> bool {
        self.updates.load(Ordering::Acquire) > 0
    }

    /// Reads the text of a scene file for a picture of the scene.
    pub(crate) fn look(&self, scene: &Scene, text: &SceneText) -> Outcome<Look> {
        Look::new(text, scene, self.key.as_ref(), self.arrow_key.as_ref())
    }
}

#[pymethods]
impl SphereData {
    /// Makes cones of arrays that Python has checked.
    #[staticmethod]
    #[pyo3(signature = (arrays, color, caps, round, text))]
    fn of_cones(
        py: Python<'_>,
        arrays: [PyReadonlyArray2<'_, f64>; 3],
        color: Option<ColorArray<'_>>,
        caps: &str,
        round: bool,
        text: SceneText,
    ) -> PyResult<Self> {
        let caps = cones::caps_of_name(caps)?;
        let cones = cones::cones(arrays.each_ref().map(|array| array.as_array()), caps);
        let colors = color.as_ref().map(ColorArray::linear).transpose()?;
        Ok(worker::run(py, None, move |_| Ok(Self::of_scene(cones::scene_of_cones(cones, colors, round, &text)?)))?)
    }

    /// The shapes of both, in a scene of their own.
    fn joined(&self, py: Python<'_>, other: Bound<'_, Self>) -> PyResult<Self> {
        let other = other.get();
        let scenes = [self.scene(), other.scene()];
        let key = self.key.clone().or_else(|| other.key.clone());
        let arrow_key = self.arrow_key.clone().or_else(|| other.arrow_key.clone());
        let z_is_up = self.z_is_up || other.z_is_up;
        // What is drawn of the data is drawn already.
        let shown = if self.kind == KindSettings::default() { &other.kind } else { &self.kind };
        let kind = KindSettings { data: String::new(), notes: Vec::new(), ..shown.clone() };
        Ok(worker::run(py, None, move |_| {
            let scene = cones::joined([&scenes[0], &scenes[1]])?;
            Ok(Self { key, arrow_key, z_is_up, kind, ..Self::of_scene(scene) })
        })?)
    }

    /// The number of cylinders and cones.
    fn cone_count(&self) -> usize {
        self.lock().cones().len()
    }

    fn __len__(&self) -> usize {
        self.count()
    }

    /// The smallest and the largest coordinates of the spheres; None if there are none.
    fn bounds(&self) -> Option<([f64; 3], [f64; 3])> {
        let bounds = self.lock().bounds()?;
        Some((bounds.min().to_array(), bounds.max().to_array()))
    }

    /// The centres as they are rendered, float64 of shape (n, 3).
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let scene = self.scene();
        let origin = scene.origin().to_array();
        let place = |[x, y, z, _]: &[f32; 4]| {
            let offset = [*x, *y, *z];
            [0, 1, 2].map(|axis| origin[axis] + f64::from(offset[axis]))
        };
        let of_data = scene.len() - scene.added();
        let places: Vec<f64> = scene.spheres()[..of_data].iter().flat_map(place).collect();
        places.into_pyarray(py).reshape([of_data, 3])
    }

    /// The radii as they are rendered, float32 of shape (n,).
    fn radii<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<f32>> {
        let scene = self.scene();
        let of_data = &scene.spheres()[..scene.len() - scene.added()];
        of_data.iter().map(|sphere| sphere[3]).collect::<Vec<_>>().into_pyarray(py)
    }

    /// The names of the columns.
    fn column_names(&self) -> Vec<String> {
        self.columns().iter().map(|column| column.name.clone()).collect()
    }

    /// The name of the kind of data, and the settings that follow from it: keys of a scene file about data, the style, and
    /// the camera with its direction, the direction that is up, and that of another view.
    fn kind(&self) -> KindOfData {
        let KindSettings { data, style, view, look, .. } = &self.kind;
        let of_views = self.traits.as_ref().map(|traits| KindSettings::new(traits, None, |key| key == "view"));
        let up_of_views = of_views.and_then(|settings| settings.view).map(|view| view.up.to_array());
        let view = view.as_ref();
        let view = view.map(|KindView { camera, direction, up }| {
            (camera.clone(), direction.map(|direction| direction.to_array()), up.to_array(), up_of_views)
        });
        (
            self.traits.as_ref().map(|traits| traits.kind.name()),
            data.clone(),
            style.map(Style::name),
            view,
            look.clone(),
        )
    }

    /// The meaning of colours, if a column gives them.
    fn color_key(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        self.key.as_ref().map(|key| arrays::in_python(py, key)).transpose()
    }

    /// The three edges of the periodic cell; None if there is none.
    fn cell(&self) -> Option<[[f64; 3]; 3]> {
        self.loaded.as_ref()?.cell
    }

    /// The direction of view of a camera that frames the spheres, and the direction that is up. The direction comes
    /// from `view`, or else from the program's default.
    #[pyo3(signature = (view, turn, up))]
    fn view_axes(&self, view: Option<&str>, turn: f64, up: Option<[f64; 3]>) -> PyResult<([f64; 3], [f64; 3])> {
        let viewpoint = match view {
            Some(name) => viewpoint(name)?,
            None => {
                let flat = self.lock().subject().flat_axis();
                flat.map_or(Viewpoint::OBLIQUE, |axis| Viewpoint::Axis { axis, is_negative: false })
            }
        };
        let usual = if self.z_is_up { DVec3::Z } else { DVec3::Y };
        let [direction, up] = viewpoint.axes(up.map_or(usual, DVec3::from), turn);
        Ok((direction.to_array(), up.to_array()))
    }

    /// The camera of a text with its position, as JSON. It frames the spheres, or the body that they sweep as they turn
    /// about an axis.
    fn placed(&self, text: SceneText, axis: Option<[f64; 3]>) -> PyResult<String> {
        let scene = self.scene();
        let framed = axis.map(|axis| swept(&scene, axis.into(), scene.subject().bounds().center()));
        let framed = framed.transpose().map_err(|error| Fault::Input(error.to_string()))?;
        Ok(look::placed(&text, framed.as_ref().unwrap_or(&scene))?)
    }

    /// Renders the view by one ray for each pixel on the device, and decides whether the picture is legal.
    fn verify(slf: Bound<'_, Self>, py: Python<'_>, text: SceneText) -> PyResult<CertificateData> {
        let this = slf.unbind();
        Ok(worker::run(py, None, move |stop| {
            let this = this.get();
            let scene = this.scene();
            certificate::verified(&scene, &this.look(&scene, &text)?, stop)
        })?)
    }

    /// Renders a picture.
    fn render(
        slf: Bound<'_, Self>,
        py: Python<'_>,
        text: SceneText,
        layers: Vec<String>,
        backend: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Picture> {
        let backend = Backend::of_name(backend)?;
        let layers = layers.iter().map(|name| name.parse::<Layer>());
        let layers = layers.collect::<Result<LayerSet, _>>().map_err(Fault::input)?;
        let this = slf.unbind();
        Ok(worker::run(py, progress.as_ref(), move |stop| {
            let this = this.get();
            let (scene, version) = this.versioned();
            let mut look = this.look(&scene, &text)?;
            let wanted = look.layers(layers);
            let for_ghosts = scene.ghosts().map_or(LayerSet::COLOR, |_| LayerSet::OF_GHOSTS);
            let layers_of_look = wanted.iter().chain(for_ghosts.iter()).collect();
            let mut rendered = this.on_device.render((&scene, version), &look, layers_of_look, backend, stop)?;
            if let Some(ghosts) = scene.ghosts() {
                look.settings = look.settings.for_ghosts();
                let over = OnDevice::default().render((ghosts, 0), &look, LayerSet::OF_GHOSTS, backend, stop)?;
                rendered.image = rendered.image.with_ghosts(&over.image, wanted);
            }
            look.notes.extend(rendered.warning);
            Ok(Picture {
                image: rendered.image,
                encoding: look.encoding,
                annotations: look.annotations,
                adapter: rendered.adapter,
                layers,
                notes: look.notes,
            })
        })?)
    }

    /// Gives spheres new centres, radii or colours, from the sphere `first` on.
    #[pyo3(signature = (first, positions, radius, color))]
    fn update(
        slf: Bound<'_, Self>,
        py: Python<'_>,
        first: u32,
        positions: Option<Centers<'_>>,
        radius: Option<PyReadonlyArray1<'_, f32>>,
        color: Option<PyReadonlyArray2<'_, u8>>,
    ) -> PyResult<()> {
        let not_in_order = || Fault::Internal("an array is not contiguous".to_owned());
        // These are copies, because other Python threads may write to the arrays while this one does not hold the GIL.
        let mut narrow: Option<Vec<[f32; 3]>> = None;
        let mut wide: Option<Vec<[f64; 3]>> = None;
        match &positions {
            Some(Centers::Narrow(centers)) => {
                let centers = centers.as_slice().map_err(|_| not_in_order())?;
                narrow = Some(centers.as_chunks::<3>().0.to_vec());
            }
            Some(Centers::Wide(centers)) => {
                let centers = centers.as_slice().map_err(|_| not_in_order())?;
                wide = Some(centers.as_chunks::<3>().0.to_vec());
            }
            None => {}
        }
        let radii = radius.as_ref().map(|radii| radii.as_slice()).transpose();
        let radii = radii.map_err(|_| not_in_order())?.map(<[f32]>::to_vec);
        let colors = color.as_ref().map(|colors| colors.as_slice()).transpose();
        let colors = colors.map_err(|_| not_in_order())?.map(|all| all.as_chunks::<4>().0.to_vec());
        let this = slf.unbind();
        Ok(worker::run(py, None, move |_| {
            let this = this.get();
            let centers = narrow.as_deref().map(NewCenters::F32);
            let centers = centers.or(wide.as_deref().map(NewCenters::F64));
            let colors = colors.as_deref().map(NewColors::Rgba8);
            if this.has_sticks && (centers.is_some() || radii.is_some()) {
                return Err(Fault::Input(
                    "these spheres have bonds, arrows or rules of show, which would not follow them; make new Spheres(...) instead"
                        .to_owned(),
                ));
            }
            let update = SceneUpdate { first, centers, radii: radii.as_deref(), colors };
            let mut locked = this.lock();
            Arc::make_mut(&mut locked).apply(&update).map_err(Fault::input)?;
            let version = 1 + this.updates.fetch_add(1, Ordering::AcqRel);
            let scene = Arc::clone(&locked);
            // A render may hold the device for long, while others ask for the scene.
            drop(locked);
            this.on_device.update((&scene, version), &update);
            Ok(())
        })?)
    }
}

fn viewpoint(name: &str) -> Outcome<Viewpoint> {
    name.parse().map_err(|error| Fault::Input(format!("view is {name:?}: {error}")))
}

/// Refuses a text that is not a viewpoint.
#[pyfunction]
pub(crate) fn check_view(view: &str) -> PyResult<()> {
    Ok(viewpoint(view).map(drop)?)
}
