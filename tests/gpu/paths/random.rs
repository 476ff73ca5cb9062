//! Tests that the checker accepts the paths of random scenes with random light. For more scenes, run
//! `cargo bench --bench verify -- lit-campaign 500`.

use libtest_mimic::{Failed, Trial};
use pinhole::verify::Outcome;

use super::{certify, record};
use crate::headless;
use crate::light::scenes::LitView;
use crate::support::effort::tries;
use crate::support::random_light;

/// How many scenes there are if all run, with one test for each.
const SEEDS: u32 = 36;

pub(crate) fn trials() -> Vec<Trial> {
    let legal = |seed| Trial::test(format!("paths::random::seed_{seed}"), move || legal(seed));
    (0..u64::from(tries(SEEDS))).map(legal).collect()
}

fn legal(seed: u64) -> Result<(), Failed> {
    let random_light::RandomView { scene, camera, film, settings, name } = random_light::view(seed);
    let view = LitView { scene, camera, film, settings };
    let certificate = certify(&view, &record(headless()?, &view)?);
    let stages = certificate.stages();
    println!("seed {seed}: {name}: {certificate}");
    // The checks of some scenes, such as those with mirrors, say little, but not those of most scenes.
    if certificate.outcome() != Outcome::Violated
        && stages.decided + stages.open > stages.checked / 2
    {
        Ok(())
    } else {
        Err(format!("seed {seed}: {name}: {certificate}").into())
    }
}
