// What all pixels of a picture share in a host's render pass. A software device reads the outputs of a vertex in less
// time than a uniform, which it reads anew for each few pixels.
// provides: Cover, host_view_of
// needs: HostView

// The members of `HostView`.
struct Cover {
    @builtin(position) place: vec4f,
    @location(0) @interpolate(flat) column: vec4f,
    @location(1) @interpolate(flat) row: vec4f,
    @location(2) @interpolate(flat) forward: vec4f,
    @location(3) @interpolate(flat) film_depth: vec4f,
    @location(4) @interpolate(flat) size: vec4f,
}

fn host_view_of(covered: Cover) -> HostView {
    return HostView(
        covered.column.xyz, covered.column.w, covered.row.xyz, covered.row.w, covered.forward.xyz, covered.forward.w,
        covered.film_depth.xyz, covered.film_depth.w, covered.size.xy, covered.size.zw,
    );
}
