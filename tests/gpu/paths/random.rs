//! Paths between whatever spheres, under whatever light: this device is never accused. Of more scenes,
//! `cargo bench --bench verify -- lit-campaign 500`.

use libtest_mimic::{Failed, Trial};

use super::scenes::LitView;
use super::{certify, record};
use crate::headless;
use crate::support::random_light;

/// Scenes whose seeds are these are followed, one a trial.
const SEEDS: std::ops::Range<u64> = 0..36;

pub(crate) fn trials() -> Vec<Trial> {
    let legal = |seed| Trial::test(format!("paths::random::seed_{seed}"), move || legal(seed));
    SEEDS.map(legal).collect()
}

fn legal(seed: u64) -> Result<(), Failed> {
    let random_light::RandomView { scene, camera, film, settings, name } = random_light::view(seed);
    let view = LitView { scene, camera, film, settings };
    let certificate = certify(&view, &record(headless()?, &view)?);
    let stages = certificate.stages();
    println!("seed {seed}: {name}: {certificate}");
    // Some say little, as those between mirrors; but not most.
    if certificate.is_legal() && stages.decided + stages.open > stages.checked / 2 {
        Ok(())
    } else {
        Err(format!("seed {seed}: {name}: {certificate}").into())
    }
}
