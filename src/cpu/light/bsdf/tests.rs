//! Tests of the energy and the densities of each surface, at several angles.

use std::f64::consts::TAU;

use super::*;
use crate::camera::sampling::{pair, unit};
use crate::light::energy::{Lobe, albedo_table, lookup};

const ROUGHNESSES: [f32; 4] = [0.1, 0.3, 0.6, 1.0];

fn views() -> impl Iterator<Item = DVec3> {
    [0.05_f64, 0.2, 0.5, 0.8, 1.0].into_iter().map(|z| {
        let (sine, cosine) = 1.1_f64.sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(cosine * across, sine * across, z)
    })
}

fn lambert(out: DVec3, roughness: f32, specular: f64) -> Bsdf {
    let energy = lookup(&albedo_table(Lobe::Reflection { roughness }), out.z);
    let lobe = Some((Ggx::of_roughness(roughness), specular, energy));
    Bsdf { out, kind: Kind::Lambert(Lambert { color: DVec3::ONE, lobe }) }
}

fn conductor(out: DVec3, roughness: f32, color: DVec3) -> Bsdf {
    let energy = lookup(&albedo_table(Lobe::Reflection { roughness }), out.z);
    Bsdf { out, kind: Kind::Conductor(Conductor { color, ggx: Ggx::of_roughness(roughness), energy }) }
}

fn glass(out: DVec3, ior: f32, roughness: f32, is_leaving: bool) -> Bsdf {
    let table = albedo_table(Lobe::Refraction { ior, roughness, is_leaving });
    let rough = Some((Ggx::of_roughness(roughness), lookup(&table, out.z)));
    let eta = if is_leaving { 1.0 / f64::from(ior) } else { f64::from(ior) };
    Bsdf { out, kind: Kind::Dielectric(Dielectric { eta, rough }) }
}

/// The mean over evenly distributed directions and random choices.
fn mean(bsdf: &Bsdf, of: impl Fn(&BsdfSample) -> f64) -> f64 {
    const COUNT: u32 = 1 << 18;
    let of_sample = |i: u32| {
        let (u, choice) = (pair(77, i, 0), unit(pair(77, i, 1)[0]));
        bsdf.scatter(u, choice).map_or(0.0, |scattered| of(&scattered))
    };
    (0..COUNT).map(of_sample).sum::<f64>() / f64::from(COUNT)
}

/// The integral over the hemisphere, by the midpoint rule.
fn integral(of: impl Fn(DVec3) -> f64) -> f64 {
    const STEPS: u32 = 400;
    let mut sum = 0.0;
    for i in 0..STEPS {
        // Midpoints are denser at small angles, where lobes are narrow.
        let angle = 0.5 * PI * (f64::from(i) + 0.5) / f64::from(STEPS);
        let (sine, cosine) = angle.sin_cos();
        for j in 0..2 * STEPS {
            let (y, x) = (PI * (f64::from(j) + 0.5) / f64::from(STEPS)).sin_cos();
            sum += sine * of(DVec3::new(sine * x, sine * y, cosine));
        }
    }
    sum * 0.5 * PI * TAU / (2.0 * f64::from(STEPS).powi(2))
}

#[test]
fn white_surfaces_lose_nothing_at_any_angle() {
    for out in views() {
        for roughness in ROUGHNESSES {
            let energies = [
                ("lobe", mean(&lambert(out, roughness, 0.5), |s| s.weight.x)),
                ("mirror", mean(&lambert(out, roughness, 1.0), |s| s.weight.x)),
                ("metal", mean(&conductor(out, roughness, DVec3::ONE), |s| s.weight.x)),
                ("glass", mean(&glass(out, 1.5, roughness, false), |s| s.weight.x)),
                ("from glass", mean(&glass(out, 1.5, roughness, true), |s| s.weight.x)),
                ("diamond", mean(&glass(out, 2.5, roughness, false), |s| s.weight.x)),
                ("from diamond", mean(&glass(out, 2.5, roughness, true), |s| s.weight.x)),
            ];
            for (what, energy) in energies {
                let difference = (energy - 1.0).abs();
                assert!(difference < 5e-3, "{what}, {roughness}, {}: {energy}", out.z);
            }
        }
    }
}

/// Samples follow the density, and weights are responses divided by densities, so means over samples equal integrals.
#[test]
fn samples_follow_densities() {
    for out in views() {
        for roughness in &ROUGHNESSES[1..] {
            let color = DVec3::new(0.9, 0.5, 0.1);
            for bsdf in [lambert(out, *roughness, 0.4), conductor(out, *roughness, color)] {
                // Two functions of direction. The first is not symmetric.
                for test in [|w: DVec3| 1.0 + w.x - 0.5 * w.y, |w: DVec3| w.z * w.z] {
                    let found = mean(&bsdf, |s| test(s.direction));
                    let wanted = integral(|w| test(w) * bsdf.response(w).unwrap().density);
                    assert!((found - wanted).abs() < 5e-3, "{bsdf:?}: {found}, not {wanted}");
                    let found = mean(&bsdf, |s| test(s.direction) * s.weight.z);
                    let wanted = integral(|w| test(w) * bsdf.response(w).unwrap().value.z * w.z);
                    assert!((found - wanted).abs() < 5e-3, "{bsdf:?}: {found}, not {wanted}");
                }
            }
        }
    }
}

/// The reflection is the same in both directions, apart from energy compensation.
#[test]
fn lobes_are_reciprocal() {
    let ggx = Ggx::of_roughness(0.5);
    for out in views() {
        for into in views() {
            let (there, back) = (ggx.reflection(out, into), ggx.reflection(into, out));
            assert!((there - back).abs() < 1e-12 * there);
        }
    }
}

/// Smooth glass refracts light according to Snell's law.
#[test]
fn light_is_refracted() {
    let out = DVec3::new(0.6, 0.0, 0.8);
    let into = Bsdf { out, kind: Kind::Dielectric(Dielectric { eta: 1.5, rough: None }) };
    let refracted = into.scatter([0; 2], 0.999).unwrap().direction;
    assert!((refracted - DVec3::new(-0.4, 0.0, -0.84_f64.sqrt())).length() < 1e-15);
    let reflected = into.scatter([0; 2], 0.0).unwrap().direction;
    assert!((reflected - DVec3::new(-0.6, 0.0, 0.8)).length() < 1e-15);
    let back = Bsdf {
        out: DVec3::new(0.4, 0.0, 0.84_f64.sqrt()),
        kind: Kind::Dielectric(Dielectric { eta: 1.0 / 1.5, rough: None }),
    };
    let refracted = back.scatter([0; 2], 0.999).unwrap().direction;
    assert!((refracted - DVec3::new(-0.6, 0.0, -0.8)).length() < 1e-15);
}

#[test]
fn fresnel_on_paper() {
    let (straight, _) = fresnel(1.0, 1.5);
    assert!((straight - 0.04).abs() < 1e-15);
    assert!(fresnel(0.0, 1.5).0 >= 1.0);
    // At Brewster's angle, only light polarised perpendicular to the plane of incidence is reflected: the fraction
    // ((η² − 1)/(η² + 1))² of it.
    let (brewster, inside) = fresnel(1.0 / 3.25_f64.sqrt(), 1.5);
    assert!((brewster - 0.5 * (1.25_f64 / 3.25).powi(2)).abs() < 1e-15, "{brewster}");
    // The reverse direction reflects the same fraction.
    let (back, _) = fresnel(inside, 1.0 / 1.5);
    assert!((back - brewster).abs() < 1e-15);
    // Total reflection occurs beyond sin = 2/3.
    assert!(fresnel((1.0 - 0.45_f64).sqrt(), 1.0 / 1.5).0 >= 1.0);
    assert!(fresnel((1.0 - 0.44_f64).sqrt(), 1.0 / 1.5).0 < 1.0);
    // Without a change of the index, nothing is reflected.
    assert!(fresnel(0.3, 1.0).0 < 1e-30);
}
