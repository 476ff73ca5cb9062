use pinhole::accel::*;
use pinhole::camera::*;
use pinhole::gpu::*;
use pinhole::*;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let name = &a[1];
    let b = std::fs::read(format!("/tmp/peers/scenes/{name}.bin")).unwrap();
    let s: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&b);
    let t = Instant::now();
    let sp: Vec<Sphere> = s
        .iter()
        .map(|s| {
            Sphere::new([s[0] as f64, s[1] as f64, s[2] as f64], s[3] as f64, LinearRgb::WHITE)
        })
        .collect();
    let scene = Scene::new(&sp).unwrap();
    drop(sp);
    println!("scene {:?}", t.elapsed());
    let h = Headless::open(&HeadlessOptions::default()).unwrap();
    let (e, l) = if name == "L1M" {
        ([-0.25, 1.10, -0.15], [0.6, 0.98, 0.55])
    } else {
        ([0.5, 0.6, -1.2], [0.5, 0.5, 0.5])
    };
    let cam =
        PinholeCamera::new(Pose::looking_at(e, l, [0., 1., 0.]).unwrap(), 1.5, [1., 1.]).unwrap();
    let film = Film::new(1024, 1024).unwrap();
    let choice =
        if a.get(2).is_some_and(|s| s == "list") { AccelChoice::List } else { AccelChoice::Auto };
    let t = Instant::now();
    let plan = h.plan(&scene, choice);
    println!("plan {:?}", t.elapsed());
    let t = Instant::now();
    let accel = plan.build(scene.spheres());
    println!(
        "build {:?} {} bricks {} planned {} B/sphere",
        t.elapsed(),
        plan.reason,
        plan.brick_count,
        plan.device_bytes() / scene.len() as u64
    );
    for b in accel.bricks() {
        if let Index::Grid(g) = &b.index {
            println!("{:?} {:?} {:?}", g.cell_counts, g.statistics(&b.spheres), b.spheres.len());
        }
    }
    let t = Instant::now();
    let buf = h.upload(&scene, &accel).unwrap();
    println!("upload {:?} {:.1} B/sphere", t.elapsed(), buf.bytes() as f64 / scene.len() as f64);
    drop(accel);
    let mut ts = vec![];
    for _ in 0..9 {
        let t = h.measure(&buf, &cam, &film, Query::Nearest).unwrap();
        ts.push(t);
    }
    ts.sort_by_key(|t| t.wall);
    println!(
        "trace min {:?} = {:.1} Mrays/s med {:?} = {:.1}, {:?}",
        ts[0].wall,
        1.048576 / ts[0].wall.as_secs_f64(),
        ts[4].wall,
        1.048576 / ts[4].wall.as_secs_f64(),
        ts[0]
    );
    if a.get(3).is_some() {
        return;
    }
    let mut id = None;
    for _ in 0..6 {
        let t = Instant::now();
        let img = h
            .render_uploaded(
                &buf,
                &cam,
                &film,
                &Settings::default().with_shading(Shading::Flat),
                LayerSet::COLOR,
                &mut |_| std::ops::ControlFlow::Continue(()),
            )
            .unwrap();
        let e = t.elapsed();
        println!("render {:?} {:.1}", e, 1048.576 / e.as_secs_f64() / 1e3);
        id = Some(img);
    }
    let img = h
        .render_uploaded(&buf, &cam, &film, &Settings::default(), LayerSet::ALL, &mut |_| {
            std::ops::ControlFlow::Continue(())
        })
        .unwrap();
    println!("hits {}", img.id().unwrap().iter().filter(|i| **i != u32::MAX).count());
    let _ = id;
    let mut hsh = 0u64;
    for (i, d) in img.id().unwrap().iter().zip(img.depth().unwrap()) {
        hsh = hsh
            .wrapping_mul(6364136223846793005)
            .wrapping_add(*i as u64 ^ ((d.to_bits() as u64) << 32));
    }
    println!("hash {hsh:x}");
}
