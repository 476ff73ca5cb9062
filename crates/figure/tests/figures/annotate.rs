//! Legends, scale bars and labels in pictures.

use pinhole::camera::{FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose};
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;
use pinhole::image::encoding::Bits;
use pinhole::{Encoding, Film, Image, SphereArray, ToneCurve, View};
use pinhole_data::load::{self, Column, ColumnValues, Labels};
use pinhole_figure::annotate::{
    Anchor, Annotation, AnnotationError, AnnotationPlan, Annotations, Canvas, Label, Legend, LegendPlan, Panel,
    Position, ScaleBar, ScaleBarPlan, pixels_per_unit,
};
use pinhole_figure::color_by::{ColorBy, ColorKey};
use pinhole_figure::scene_file::{OwnShapes, SceneFile};
use pinhole_figure::write::png as png_file;

use crate::pictures::{plain, read_png};

/// A colour key of categories.
fn categories(names: &[&str]) -> ColorKey {
    let labels = Labels {
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        indices: (0..names.len() as u32).collect(),
    };
    let columns = [Column { name: "kind".to_owned(), values: ColumnValues::Labels(labels) }];
    let spheres = SphereArray::F32(vec![[0.0; 4]; names.len()]);
    ColorBy::column("kind").apply(&spheres, &columns).unwrap().key
}

/// A colour key of a scale.
fn scale(values: &[f64], is_log: bool) -> ColorKey {
    let values = ColumnValues::Numbers(values.to_vec());
    let columns = [Column { name: "value".to_owned(), values }];
    let spheres = SphereArray::F32(vec![[0.0; 4]; 2]);
    let by = ColorBy { is_log, ..ColorBy::column("value") };
    by.apply(&spheres, &columns).unwrap().key
}

/// A picture of one colour.
fn flat([width, height]: [u32; 2], level: f32) -> Image {
    plain([width, height], vec![[level; 3]; (width * height) as usize])
}

/// Neither exposure nor a tone curve changes the colours of annotations.
#[test]
fn exposure_and_tone_leave_annotations_alone() {
    let key = categories(&["A", "B", "C"]);
    let annotations = Annotations::default().with(Annotation::Legend(Legend::new(key)));
    let image = flat([400, 300], 0.9);
    let mut strong = Encoding::default().with_exposure(1.0).unwrap();
    strong.tone = ToneCurve::Agx;
    let mut fine = strong;
    fine.bits = Bits::Sixteen;
    for (encoding, step) in [(Encoding::default(), 1), (strong, 1), (fine, 2)] {
        let plain = read_png(&png_file::encode(&image, &encoding).unwrap()).1;
        let file = png_file::encode_annotated(&image, &encoding, &annotations).unwrap();
        let drawn = read_png(&file).1;
        assert_eq!(plain.len(), drawn.len());
        for color in [[0xe6, 0x9f, 0x00], [0x56, 0xb4, 0xe9], [0x00, 0x9e, 0x73]] {
            let pixel: Vec<u8> = color.iter().flat_map(|byte| vec![*byte; step]).collect();
            let count = drawn.chunks_exact(3 * step).filter(|found| **found == pixel).count();
            assert!(count > 40, "{color:?} in {count} pixels");
        }
    }
    let nothing = Annotations::default();
    let file = png_file::encode_annotated(&image, &strong, &nothing).unwrap();
    assert_eq!(file, png_file::encode(&image, &strong).unwrap());
}

#[test]
fn text_is_black_on_light_and_white_on_dark() {
    for (level, ink) in [(1.0, 0), (0.5, 0), (0.0, 255), (0.03, 255)] {
        let annotations = Annotations::default()
            .with(Annotation::Label(Label { text: "MMMM".to_owned(), position: Position::TOP_LEFT }));
        let image = flat([800, 900], level);
        let file = png_file::encode_annotated(&image, &Encoding::default(), &annotations).unwrap();
        let drawn = read_png(&file).1;
        assert!(drawn.contains(&ink), "{level}");
        assert_eq!(drawn.contains(&(255 - ink)), level == 0.0 || level == 1.0, "{level}");
    }
}

/// A panel lies behind text where the picture is mixed, and nowhere else.
#[test]
fn a_panel_lies_where_the_picture_is_mixed() {
    let size = [300_u32, 200_u32];
    let stripes: Vec<u8> =
        (0..size[0] * size[1]).flat_map(|pixel| [if pixel % 20 < 10 { 0 } else { 255 }; 3]).collect();
    let label = Label { text: "text".to_owned(), position: Position::TOP_LEFT };
    let drawn = |panel, mut samples: Vec<u8>| {
        let annotations = Annotations { panel, ..Annotations::default() }.with(Annotation::Label(label.clone()));
        annotations.draw(&mut Canvas::new(size, 3, Bits::Eight, &mut samples).unwrap());
        samples
    };
    assert_eq!(drawn(Panel::Auto, stripes.clone()), drawn(Panel::Always, stripes.clone()));
    assert_ne!(drawn(Panel::Never, stripes.clone()), drawn(Panel::Always, stripes));
    let light = vec![230; (3 * size[0] * size[1]) as usize];
    assert_eq!(drawn(Panel::Auto, light.clone()), drawn(Panel::Never, light));
}

/// Annotations of any kind and size cause no panic, and do not change the picture far from them.
#[test]
fn annotations_fit_pictures_of_any_size() {
    let names: Vec<String> = (0..500).map(|i| format!("name {i}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let long = "a very long title that no picture has room for ".repeat(10);
    let keys = [
        categories(&["A"]),
        categories(&names),
        scale(&[0.0, 1.0], false),
        scale(&[1e-12, 1e12], true),
        scale(&[1e300, f64::NAN], false),
    ];
    for size in [[1, 1], [7, 300], [300, 7], [64, 48], [640, 480]] {
        for key in &keys {
            for anchor in Anchor::ALL {
                let mut legend = Legend::new(key.clone());
                legend.position = Position::Anchor(anchor);
                for title in [None, Some(long.clone()), Some(String::new())] {
                    legend.title = title;
                    let mut samples = vec![255; (4 * size[0] * size[1]) as usize];
                    let mut canvas = Canvas::new(size, 4, Bits::Eight, &mut samples).unwrap();
                    Annotations::default().with(Annotation::Legend(legend.clone())).draw(&mut canvas);
                }
            }
        }
    }
}

/// Two labels in one corner are stacked.
#[test]
fn what_shares_a_corner_is_stacked() {
    let size = [300_u32, 200_u32];
    let rows = |annotations: &Annotations| {
        let mut samples = vec![255; (3 * size[0] * size[1]) as usize];
        annotations.draw(&mut Canvas::new(size, 3, Bits::Eight, &mut samples).unwrap());
        let is_dark = |row: &[u8]| row.iter().any(|sample| *sample < 128);
        samples.chunks_exact(3 * size[0] as usize).map(is_dark).collect::<Vec<bool>>()
    };
    let label =
        |text: &str, anchor| Annotation::Label(Label { text: text.to_owned(), position: Position::Anchor(anchor) });
    for anchor in [Anchor::TopRight, Anchor::Left, Anchor::Bottom] {
        let one = rows(&Annotations::default().with(label("H", anchor)));
        let two = Annotations::default().with(label("H", anchor)).with(label("H", anchor));
        let two = rows(&two);
        let count = |rows: &[bool]| rows.iter().filter(|row| **row).count();
        assert_eq!(count(&two), 2 * count(&one), "{anchor:?}");
    }
}

#[test]
fn a_scale_bar_is_as_long_as_its_length() {
    let film = Film::new(200, 100).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 50.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = OrthographicCamera::new(pose, [10.0, 5.0]).unwrap();
    let view = View::new(&camera, film);
    for depth in [0.0, 30.0, -4000.0] {
        let scale = pixels_per_unit(&view, DVec3::new(1.0, 2.0, depth)).unwrap();
        assert!((scale - 10.0).abs() < 1e-9, "{scale}");
    }
    let camera = PinholeCamera::with_vertical_fov(pose, 0.5, film.aspect()).unwrap();
    let view = View::new(&camera, film);
    let scale = pixels_per_unit(&view, DVec3::new(0.5, -0.25, 10.0)).unwrap();
    // A picture of 100 pixels is 2 · 40 · tan 0.25 high at the distance of 40.
    assert!((scale - 100.0 / (80.0 * 0.25_f64.tan())).abs() < 1e-9, "{scale}");
    let behind = pixels_per_unit(&view, DVec3::new(0.0, 0.0, 60.0)).unwrap_err().to_string();
    assert!(behind.ends_with("the middle of the scene lies behind the camera"), "{behind}");
    let fisheye = FisheyeCamera::new(pose, 2.0, film.aspect()).unwrap();
    let view = View::new(&fisheye, film);
    let bent = pixels_per_unit(&view, DVec3::ZERO).unwrap_err().to_string();
    assert!(bent.starts_with("a scale bar has no meaning for the camera `fisheye`"), "{bent}");

    let bar = |length| ScaleBar::new(10.0, length, "Å", 800);
    let refused = |length| bar(Some(length)).unwrap_err().to_string();
    assert_eq!(bar(None).unwrap().text(), "20 Å");
    assert_eq!(bar(Some(2.5)).unwrap().pixels(), 25.0);
    for length in [0.0, -1.0, f64::NAN] {
        assert!(refused(length).ends_with("it must be finite and greater than 0"));
    }
    assert!(refused(1e9).starts_with("a scale bar of 1e9 would be 1e10 pixels long"));
    assert_eq!(ScaleBar::new(2e7, None, "", 800).unwrap().text(), "10⁻⁵");

    // The bar that is drawn has as many dark pixels in its row.
    let mut samples = vec![255; 3 * 800 * 200];
    let annotations = Annotations::default().with(Annotation::ScaleBar(bar(Some(30.0)).unwrap()));
    annotations.draw(&mut Canvas::new([800, 200], 3, Bits::Eight, &mut samples).unwrap());
    let dark = |row: &[u8]| row.iter().filter(|sample| **sample == 0).count() / 3;
    let longest = samples.chunks_exact(3 * 800).map(dark).max();
    assert_eq!(longest, Some(300));
}

#[test]
fn dots_per_inch_are_written_in_metres() {
    let image = flat([2, 2], 0.5);
    let encoding = Encoding::default().with_dots_per_inch(Some(300.0)).unwrap();
    let (info, _) = read_png(&png_file::encode(&image, &encoding).unwrap());
    let dims = info.pixel_dims.unwrap();
    assert_eq!((dims.xppu, dims.yppu, dims.unit), (11811, 11811, png::Unit::Meter));
    let (info, _) = read_png(&png_file::encode(&image, &Encoding::default()).unwrap());
    assert!(info.pixel_dims.is_none());
    for bad in [0.0, -1.0, f32::NAN, 1e9] {
        assert!(Encoding::default().with_dots_per_inch(Some(bad)).is_err());
    }
}

#[test]
fn a_plan_becomes_annotations() {
    let film = Film::new(400, 300).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 50.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.5, film.aspect()).unwrap();
    let view = View::new(&camera, film);
    let plan = AnnotationPlan {
        legend: Some(LegendPlan::default()),
        scale_bar: Some(ScaleBarPlan::default()),
        labels: vec![Label { text: "水".to_owned(), position: Position::TOP_LEFT }],
        ..AnnotationPlan::default()
    };
    let key = categories(&["A"]);
    let (drawn, notes) = plan.annotations(Some(&key), None, &view, DVec3::ZERO).unwrap();
    assert_eq!(drawn.items.len(), 3);
    assert!(notes[0].contains("is true at the distance of the middle of the scene, 50"));
    assert!(notes[1].contains("lacks 水"), "{notes:?}");
    let none = plan.annotations(None, None, &view, DVec3::ZERO);
    assert_eq!(none.unwrap_err(), AnnotationError::NoKey);
}

#[test]
fn the_arrow_of_a_legend_is_as_long_as_those_of_the_picture() {
    let film = Film::new(400, 300).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 50.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = OrthographicCamera::new(pose, [20.0, 15.0]).unwrap();
    let view = View::new(&camera, film);
    let text = "1\nProperties=species:S:1:pos:R:3:force:R:3\nO 0 0 0 0 0 4\n";
    let loaded = load::from_bytes(text.as_bytes(), "a.xyz", &load::Options::default()).unwrap();
    let file = SceneFile::parse("data = 'a.xyz'\narrows = { vector = 'force', scale = 0.3 }\n[legend]").unwrap();
    let key = file.data().unwrap().scene(loaded, &OwnShapes::default()).unwrap().arrow_key.unwrap();
    // A unit of length has 10 pixels, and an eighth of the width 50.
    let (drawn, notes) = file.annotations.annotations(None, Some(&key), &view, DVec3::ZERO).unwrap();
    let [Annotation::KeyArrow(arrow)] = &drawn.items[..] else { panic!("{drawn:?}") };
    assert_eq!((arrow.value(), arrow.position, notes), (10.0, Position::RIGHT, Vec::new()));
    assert!((arrow.pixels() - 30.0).abs() < 1e-9);
    let mut rgb = vec![255; 3 * 400 * 300];
    drawn.draw_over([400, 300], &Encoding::default(), &mut rgb);
    let green = rgb.chunks_exact(3).filter(|pixel| *pixel == arrow.color).count();
    assert!((20..200).contains(&green), "{green}");
    // The camera leaves room for it, and a panorama, whose scale differs everywhere, has none.
    assert!(file.annotations.free_sides(None, film)[1] > 0.1);
    let panorama = PanoramaCamera::new(pose);
    let (drawn, notes) =
        file.annotations.annotations(None, Some(&key), &View::new(&panorama, film), DVec3::ZERO).unwrap();
    assert!(drawn.is_empty() && notes[0].starts_with("the legend has no arrow: "), "{notes:?}");
}

#[test]
fn scene_files_have_keys_for_all_of_it() {
    let text = r##"
        data = "a.xyz"
        radius_by = { column = "mass", factor = 0.5 }
        opacity_by = "occupancy"
        [color_by]
        column = "b_factor"
        map = "vik_r"
        range = ["2%", 98]
        log = true
        missing = "#ff0000"
        [legend]
        title = "B (Å²)"
        position = "bottom"
        [scale_bar]
        length = 20
        unit = "Å"
        [[labels]]
        text = "a"
        position = [0.5, 0.25]
        [[labels]]
        text = "b"
        [text]
        scale = 2
        color = "white"
        panel = "never"
        [output]
        dpi = 300
    "##;
    let file = SceneFile::parse(text).unwrap();
    let mapping = &file.data().unwrap().mapping;
    let expected = ColorBy {
        map: Some("vik_r".parse().unwrap()),
        limits: "2%,98".parse().unwrap(),
        is_log: true,
        missing: [255, 0, 0],
        ..ColorBy::column("b_factor")
    };
    assert_eq!(mapping.color, Some(expected));
    assert_eq!(mapping.radius.as_ref().unwrap().factor, 0.5);
    assert_eq!(mapping.opacity.as_deref(), Some("occupancy"));
    let plan = &file.annotations;
    assert_eq!(plan.legend.as_ref().unwrap().title.as_deref(), Some("B (Å²)"));
    assert_eq!(plan.scale_bar.as_ref().unwrap().length, Some(20.0));
    assert_eq!(plan.labels[0].position, Position::At([0.5, 0.25]));
    assert_eq!(plan.labels[1].position, Position::TOP_LEFT);
    let look = (plan.text.scale, plan.text.color.map(pinhole::LinearRgb::to_srgb8), plan.text.panel);
    assert_eq!(look, (Some(2.0), Some([255; 3]), Some(Panel::Never)));
    assert_eq!(file.encoding.dots_per_inch(), Some(300.0));
}

/// The number of pixels that are mostly red, green or blue, and their mean place relative to the middle of all.
fn axes_drawn(text: &str) -> [(usize, [f32; 2]); 3] {
    let file = SceneFile::parse(text).unwrap();
    let film = file.film;
    let camera = file.camera_parameters().camera(film.aspect(), &Bounds::of_sphere(DVec3::ZERO, 1.0).into()).unwrap();
    let view = View::new(camera.as_ref(), film);
    let (drawn, notes) = file.annotations.annotations(None, None, &view, DVec3::ZERO).unwrap();
    assert_eq!(notes, [] as [&str; 0]);
    let size = [film.width(), film.height()];
    let mut rgb = vec![255; 3 * film.pixel_count() as usize];
    drawn.draw(&mut Canvas::new(size, 3, Bits::Eight, &mut rgb).unwrap());
    let places = |channel: usize| {
        let is_shown = |pixel: &[u8]| {
            (0..3).all(|other| other == channel || i32::from(pixel[channel]) - i32::from(pixel[other]) > 60)
        };
        let shown = rgb.chunks(3).enumerate().filter(move |(_, pixel)| is_shown(pixel));
        shown.map(|(index, _)| [(index as u32 % size[0]) as f32, (index as u32 / size[0]) as f32]).collect::<Vec<_>>()
    };
    let mean = |places: &[[f32; 2]]| {
        [0, 1].map(|axis| places.iter().map(|place| place[axis]).sum::<f32>() / places.len() as f32)
    };
    let all = [0, 1, 2].map(places);
    // The arrows start at one point: the end of one is twice as far as its mean, more or less.
    let origin = mean(&all.concat());
    all.map(|places| {
        let at = mean(&places);
        (places.len(), [at[0] - origin[0], at[1] - origin[1]])
    })
}

#[test]
fn axes_point_as_the_camera_sees_them() {
    let front = "[film]\nwidth = 400\nheight = 300\n[camera.orthographic]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\nhalf_extent = [4, 3]\n[axes]\n";
    // x is to the right and y up; z points at the eye.
    let [x, y, z] = axes_drawn(front);
    assert!(x.0 > 20 && y.0 > 20 && z.0 < x.0, "{x:?} {y:?} {z:?}");
    assert!(x.1[0] > y.1[0] + 4.0 && y.1[1] < x.1[1] - 4.0, "{x:?} {y:?}");
    // Rows from below: the picture is the same upside down.
    let [x, y, _] = axes_drawn(&front.replace("height = 300", "height = 300\ny = \"down\""));
    assert!(x.1[0] > y.1[0] + 4.0 && y.1[1] > x.1[1] + 4.0, "{x:?} {y:?}");
    // From the side, z is to the right and x points away.
    let [x, _, z] =
        axes_drawn(&front.replace("[0, 0, 9]", "[-9, 0, 0]").replace("[axes]", "[axes]\nposition = \"top\""));
    assert!(z.1[0] > x.1[0] + 4.0 && x.0 < z.0, "{x:?} {z:?}");
}
