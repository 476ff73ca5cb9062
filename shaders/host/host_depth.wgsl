// The depth of the host at a pixel, and the camera that it was rendered with.
// provides: host_depth_at, host_view
// needs: HostView

// The host's camera.
@group(1) @binding(0) var<uniform> host_view: HostView;
// Depth texture of the host.
@group(1) @binding(1) var host_depth: texture_depth_2d;

fn host_depth_at(pixel_in_film: vec2u) -> f32 {
    return textureLoad(host_depth, pixel_in_film + vec2u(host_view.first_pixel), 0);
}
