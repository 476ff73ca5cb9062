//! Which wgpu the library takes is written in three places, which must agree.

use pinhole::gpu::WGPU_VERSION;

fn file(path: &str) -> String {
    std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Every requirement of wgpu in the manifest is of the version that the library and its documentation name.
#[test]
fn the_documented_version_of_wgpu_is_that_of_the_manifest() {
    let manifest = file("Cargo.toml");
    let required: Vec<&str> = manifest
        .lines()
        .filter_map(|line| line.strip_prefix("wgpu = { version = \""))
        .filter_map(|rest| rest.split('"').next())
        .collect();
    assert!(required.len() >= 2, "{required:?}");
    for version in &required {
        assert!(
            version.starts_with(&format!("{WGPU_VERSION}.")),
            "{version} is not {WGPU_VERSION}"
        );
    }
    let release = env!("CARGO_PKG_VERSION");
    let row = format!("| {release} | {WGPU_VERSION} |");
    assert!(file("docs/embedding.md").contains(&row), "docs/embedding.md lacks the row `{row}`");
    let major = WGPU_VERSION.split('.').next().unwrap();
    let said = format!("wgpu {major}");
    for page in ["docs/embedding.md", "CHANGELOG.md"] {
        assert!(file(page).contains(&said), "{page} does not say `{said}`");
    }
}
