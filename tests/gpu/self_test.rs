//! Tests that the adapter has the properties that the error bounds assume.

use libtest_mimic::Trial;
use pinhole::gpu::{Headless, HeadlessOptions, SelfTestExtent, TestedProperty};
use pinhole::internals::ShaderEdit;

use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("self_test::the_adapter_has_all_properties", full),
        trial("self_test::a_part_is_quick", quick),
        trial("self_test::fences_that_a_driver_sees_through_are_found", seen_through),
    ]
}

const QUICK: &[&str] = &["fence", "add_multiply", "divide", "sqrt", "inverse_sqrt", "dot"];

fn full(headless: &'static Headless) {
    let report = headless.self_test(SelfTestExtent::Full).unwrap();
    let names: Vec<_> = report.properties().iter().map(|property| property.name).collect();
    let rest = ["subnormals", "comparison_and_conversion", "loops", "fence_in_trace"];
    assert_eq!(names, [QUICK, &rest].concat());
    assert!(report.passed(), "{:?}", report.first_failure());
}

fn quick(headless: &'static Headless) {
    let report = headless.self_test(SelfTestExtent::Quick).unwrap();
    let names: Vec<_> = report.properties().iter().map(|property| property.name).collect();
    assert_eq!(names, QUICK);
    assert!(report.passed(), "{:?}", report.first_failure());
}

fn fences_in_trace(headless: &Headless) -> TestedProperty {
    let report = headless.self_test(SelfTestExtent::Full).unwrap();
    report.properties().iter().find(|property| property.name == "fence_in_trace").unwrap().clone()
}

/// A driver that knows that the zero of fences is one, in kernels that trace rays only.
fn seen_through(headless: &'static Headless) {
    let sound = fences_in_trace(headless);
    println!("{sound}");
    let (_, rewritten) =
        sound.figures.iter().find(|(name, _)| *name == "unfenced_rewritten_percent").unwrap();
    let edit = ShaderEdit {
        file: "scene/frame.wgsl".to_owned(),
        find: "frame.iteration_limit ^ frame.iteration_limit_again".to_owned(),
        replace: "0u".to_owned(),
    };
    let options = HeadlessOptions { edits: vec![edit], ..HeadlessOptions::default() };
    let known = fences_in_trace(&Headless::open(&options).unwrap());
    println!("{known}");
    // Some drivers rewrite nothing.
    assert_eq!(known.passed(), *rewritten < 1.0, "{known}");
}
