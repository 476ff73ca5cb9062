// The depth of a pixel of a picture that is drawn into a host's render pass, and whether it is drawn.

//// primary
// Pixels are drawn where the rays through their centres hit.
// provides: depth_of_picture
// needs: HostView, center_of, clip_depth

// Depth layer of the picture: distances along the rays, 1e30 for a miss.
@group(0) @binding(2) var depth_layer: texture_2d<f32>;

struct PictureDepth {
    depth: f32,
    is_drawn: bool,
}

fn depth_of_picture(view: HostView, pixel: vec2f, alpha: f32) -> PictureDepth {
    let distance = textureLoad(depth_layer, vec2i(pixel), 0).r;
    return PictureDepth(clip_depth(view, center_of(view, pixel), distance), distance < 1e30);
}

//// lit
// Pixels are drawn where they are not transparent, which may be beside all hits: at silhouettes, and where a shadow
// falls. Their depth is that of the ray through their centre or, if it misses, the nearest one of the eight pixels
// around, or the far end of the range.
// provides: depth_of_picture
// needs: HostView, center_of, clip_depth, is_behind

// Depth layer of the picture, as above.
@group(0) @binding(2) var depth_layer: texture_2d<f32>;

struct PictureDepth {
    depth: f32,
    is_drawn: bool,
}

// The depth of a hit. A miss, or a pixel outside, has the depth `if_missed`.
fn depth_at(view: HostView, pixel: vec2f, if_missed: f32) -> f32 {
    let center = center_of(view, pixel);
    let distance = textureLoad(depth_layer, vec2i(pixel), 0).r;
    let is_hit = distance < 1e30 && all(abs(center) < view.size);
    return select(if_missed, clip_depth(view, center, distance), is_hit);
}

fn depth_of_picture(view: HostView, pixel: vec2f, alpha: f32) -> PictureDepth {
    // Behind everything that depth can be in any format.
    let missed = select(1e30, -1e30, view.far == 0.0);
    var depth = depth_at(view, pixel, missed);
    // A loop that ends at once is passed over by software devices; the branches of a condition are not.
    for (var i = select(9, 0, alpha > 0.0 && depth == missed); i < 9; i++) {
        let here = depth_at(view, pixel + vec2f(vec2i(i % 3, i / 3) - 1), missed);
        depth = select(depth, here, is_behind(view, depth, here));
    }
    return PictureDepth(select(depth, view.far, depth == missed), alpha > 0.0);
}
