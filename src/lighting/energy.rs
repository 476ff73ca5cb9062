//! Stub.
pub(crate) fn reflection(_roughness: f32) -> [f32; 128] {
    [1.0; 128]
}
pub(crate) fn dielectric(_ior: f32, _roughness: f32) -> [[f32; 128]; 2] {
    [[1.0; 128]; 2]
}
