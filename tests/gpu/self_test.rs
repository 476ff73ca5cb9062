//! Tests that the adapter has the properties that the error bounds assume.

use libtest_mimic::Trial;
use pinhole::gpu::{Headless, SelfTestExtent};

use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("self_test::the_adapter_has_all_properties", full),
        trial("self_test::a_part_is_quick", quick),
    ]
}

const QUICK: &[&str] = &["fence", "add_multiply", "divide", "sqrt", "inverse_sqrt", "dot"];

fn full(headless: &'static Headless) {
    let report = headless.self_test(SelfTestExtent::Full).unwrap();
    let names: Vec<_> = report.properties().iter().map(|property| property.name).collect();
    let rest = ["subnormals", "comparison_and_conversion", "loops"];
    assert_eq!(names, [QUICK, &rest].concat());
    assert!(report.passed(), "{:?}", report.first_failure());
}

fn quick(headless: &'static Headless) {
    let report = headless.self_test(SelfTestExtent::Quick).unwrap();
    let names: Vec<_> = report.properties().iter().map(|property| property.name).collect();
    assert_eq!(names, QUICK);
    assert!(report.passed(), "{:?}", report.first_failure());
}
