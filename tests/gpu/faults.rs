//! Faults of shaders that the checker must find: each changes a picture, and none by much more than it must.

use pinhole::accel::AccelChoice;

use crate::support::View;
use crate::verify_views as views;

/// A shader with a fault, and where it shows.
pub(crate) struct Fault {
    pub(crate) name: &'static str,
    pub(crate) view: fn() -> View,
    pub(crate) how: How,
    pub(crate) file: &'static str,
    pub(crate) find: &'static str,
    pub(crate) replace: &'static str,
}

/// In which structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct How {
    pub(crate) choice: AccelChoice,
    pub(crate) binding_bytes: u64,
    pub(crate) rays: u64,
}

const fn how(choice: AccelChoice) -> How {
    How { choice, binding_bytes: 1 << 27, rays: u64::MAX }
}

pub(crate) const LIST: How = how(AccelChoice::List);
const GRID: How = how(AccelChoice::Grid);
const TREE: How = how(AccelChoice::Tree);
const BINARY: How = how(AccelChoice::BinaryTree);
/// So few rays that cells refer to spheres.
const REFERENCES: How = How { rays: 1, ..GRID };
/// Bindings so small that there are several bricks.
pub(crate) const BRICKS: How = How { binding_bytes: 16 * 100, ..LIST };

type Row = (&'static str, fn() -> View, How, &'static str, &'static str, &'static str);

pub(crate) fn all() -> Vec<Fault> {
    [CAMERA, ENTRY, SPHERE, SHADE, TIES, GRIDS, TREES, SCHEDULE]
        .into_iter()
        .flatten()
        .map(|&(name, view, how, file, find, replace)| Fault {
            name,
            view,
            how,
            file,
            find,
            replace,
        })
        .collect()
}

const CAMERA: &[Row] = &[
    ("pixel_center_off_by_half", views::balls, LIST, "film.wgsl", "* 2 + 1 - size", "* 2 - size"),
    (
        "location_stretched_by_a_hundred_thousandth",
        views::balls,
        LIST,
        "film.wgsl",
        "fence(location.x)",
        "fence(location.x * 1.00001)",
    ),
    ("y_upside_down", views::balls, LIST, "film.wgsl", "-frame.y_sign", "frame.y_sign"),
    (
        "u_and_v_swapped",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "location.x * camera.right + location.y * camera.up",
        "location.x * camera.up + location.y * camera.right",
    ),
    (
        "u_negated",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "location.x * camera.right",
        "-location.x * camera.right",
    ),
    (
        "w_negated",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "aside + camera.forward",
        "aside - camera.forward",
    ),
    (
        "view_plane_too_near",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "aside + camera.forward",
        "aside + 0.99999 * camera.forward",
    ),
    (
        "direction_not_unit",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "toward * (1.0 / length)",
        "toward",
    ),
    (
        "one_over_length_to_18_bits",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "(1.0 / length)",
        "(1.000004 / length)",
    ),
    (
        "eye_on_the_axis",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "camera.origin + camera.advance * aside",
        "camera.origin",
    ),
    (
        "distance_along_the_axis",
        views::balls,
        LIST,
        "camera_pinhole.wgsl",
        "camera.advance * length",
        "camera.advance",
    ),
    (
        "parallel_u_and_v_swapped",
        views::parallel,
        LIST,
        "camera_orthographic.wgsl",
        "location.x * camera.right + location.y * camera.up",
        "location.y * camera.right + location.x * camera.up",
    ),
    (
        "parallel_rays_diverge",
        views::parallel,
        LIST,
        "camera_orthographic.wgsl",
        "camera.forward)",
        "normalize(camera.forward + 0.00001 * aside))",
    ),
];

const ENTRY: &[Row] = &[
    (
        "entry_without_z",
        views::balls,
        LIST,
        "enter.wgsl",
        "max(near.x, max(near.y, near.z))",
        "max(near.x, near.y)",
    ),
    (
        "entry_at_the_exit",
        views::balls,
        LIST,
        "enter.wgsl",
        "let t_near = max(max(near.x",
        "let t_near = max(max(far.x",
    ),
    (
        "entry_beyond_the_wall",
        views::balls,
        LIST,
        "enter.wgsl",
        "ray.origin + t_near * ray.direction",
        "ray.origin + (t_near + 0.001) * ray.direction",
    ),
    ("box_test_inverted", views::balls, LIST, "enter.wgsl", "t_near <= t_far", "t_near > t_far"),
    (
        "way_to_the_box_not_counted",
        views::balls,
        LIST,
        "enter.wgsl",
        "camera_ray.distance + t_near",
        "camera_ray.distance",
    ),
];

const SPHERE: &[Row] = &[
    (
        "far_root_for_near",
        views::balls,
        LIST,
        "sphere.wgsl",
        "select(half_chord, -half_chord, c > 0.0)",
        "select(-half_chord, half_chord, c > 0.0)",
    ),
    (
        "near_root_from_inside",
        views::inside,
        LIST,
        "sphere.wgsl",
        "select(half_chord, -half_chord, c > 0.0)",
        "-half_chord",
    ),
    (
        "textbook_discriminant",
        views::far_clusters,
        LIST,
        "sphere.wgsl",
        "fence(radius * radius - dot(foot_to_center, foot_to_center))",
        "fence(b * b - fence(dot(to_center, to_center) - radius * radius))",
    ),
    (
        "radius_not_squared",
        views::balls,
        LIST,
        "sphere.wgsl",
        "fence(radius * radius - dot(foot",
        "fence(radius - dot(foot",
    ),
    (
        "radius_too_large_by_a_ten_thousandth",
        views::balls,
        LIST,
        "sphere.wgsl",
        "let radius = sphere.w;",
        "let radius = sphere.w * 1.0001;",
    ),
    (
        "hits_behind_the_eye",
        views::behind,
        LIST,
        "sphere.wgsl",
        "discriminant >= 0.0 && t > 0.0",
        "discriminant >= 0.0",
    ),
    (
        "tangents_far_inside_missed",
        views::balls,
        LIST,
        "sphere.wgsl",
        "discriminant >= 0.0",
        "discriminant >= 0.001",
    ),
    (
        "distance_of_the_center",
        views::balls,
        LIST,
        "sphere.wgsl",
        "select(NO_HIT, t, is_hit)",
        "select(NO_HIT, b, is_hit)",
    ),
    (
        "distance_off_by_a_hundred_thousandth",
        views::balls,
        LIST,
        "sphere.wgsl",
        "select(NO_HIT, t, is_hit)",
        "select(NO_HIT, t * 1.00001, is_hit)",
    ),
    (
        "center_moved_with_the_eye",
        views::balls,
        LIST,
        "sphere.wgsl",
        "fence3(sphere.xyz - ray.origin)",
        "fence3(sphere.xyz - 0.9999 * ray.origin)",
    ),
];

const SHADE: &[Row] = &[
    (
        "normal_not_unit",
        views::balls,
        LIST,
        "sphere.wgsl",
        "outward / sqrt(dot(outward, outward))",
        "outward",
    ),
    (
        "normal_short_by_a_hundred_thousandth",
        views::balls,
        LIST,
        "sphere.wgsl",
        "outward / sqrt(",
        "0.99999 * outward / sqrt(",
    ),
    ("normal_inward", views::balls, LIST, "sphere.wgsl", "outward / sqrt(", "-outward / sqrt("),
    (
        "normal_of_the_foot_point_mirrored",
        views::balls,
        LIST,
        "sphere.wgsl",
        "ray.direction - hit.foot_to_center",
        "ray.direction + hit.foot_to_center",
    ),
    (
        "sphere_of_the_next_place",
        views::balls,
        LIST,
        "shade.wgsl",
        "hit.place - brick.first_place;",
        "hit.place - brick.first_place + 1u;",
    ),
    (
        "id_in_the_picture_off_by_one",
        views::balls,
        LIST,
        "shade.wgsl",
        "normal, hit.id);",
        "normal, hit.id + 1u);",
    ),
    ("depth_from_the_box", views::balls, LIST, "shade.wgsl", "hit.distance + hit.t", "hit.t"),
    (
        "depth_not_along_the_ray",
        views::balls,
        LIST,
        "shade.wgsl",
        "hit.distance + hit.t",
        "(hit.distance + hit.t) * dot(entry.ray.direction, normalize(frame.camera.forward))",
    ),
    (
        "color_decoded_twice",
        views::balls,
        LIST,
        "shade.wgsl",
        "let color = palette[color_indices[min(place, brick.last_color)]].rgb;",
        "let color = pow(palette[color_indices[min(place, brick.last_color)]].rgb, vec3f(2.2));",
    ),
    (
        "red_and_blue_swapped",
        views::balls,
        LIST,
        "shade.wgsl",
        "brick.last_color)]].rgb",
        "brick.last_color)]].bgr",
    ),
    (
        "color_of_the_neighbor",
        views::balls,
        LIST,
        "shade.wgsl",
        "color_indices[min(place,",
        "color_indices[min(place + 1u,",
    ),
    (
        "cosine_squared",
        views::balls,
        LIST,
        "shading.wgsl",
        "color * abs(",
        "color * abs(dot(normal, ray.direction)) * abs(",
    ),
    (
        "dark_from_inside",
        views::inside,
        LIST,
        "shading.wgsl",
        "abs(dot(normal, ray.direction))",
        "max(dot(normal, -ray.direction), 0.0)",
    ),
    (
        "background_dimmed",
        views::balls,
        LIST,
        "shade.wgsl",
        "write_color(pixel, frame.background)",
        "write_color(pixel, 0.999999 * frame.background)",
    ),
    (
        "misses_have_a_depth",
        views::balls,
        LIST,
        "shade.wgsl",
        "write_layers(pixel, hit.t, vec3f(0.0)",
        "write_layers(pixel, 0.0, vec3f(0.0)",
    ),
];

const TIES: &[Row] = &[
    ("last_of_equal_spheres_in_a_list", views::copies, LIST, "list.wgsl", "here < t", "here <= t"),
    (
        "last_of_equal_spheres_in_a_leaf",
        views::copies,
        TREE,
        "leaf.wgsl",
        "found < t",
        "found <= t",
    ),
    (
        "no_tie_rule_between_leaves",
        views::copies,
        TREE,
        "brick.wgsl",
        "t < (*nearest).t || id < (*nearest).id",
        "t < (*nearest).t",
    ),
    (
        "tie_rule_the_wrong_way_round",
        views::copies,
        BRICKS,
        "brick.wgsl",
        "id < (*nearest).id",
        "id > (*nearest).id",
    ),
    ("farthest_for_nearest", views::balls, LIST, "list.wgsl", "here < t", "here > t"),
    (
        "id_off_by_one",
        views::balls,
        LIST,
        "trace.wgsl",
        "Hit(nearest.t, nearest.id,",
        "Hit(nearest.t, nearest.id + 1u,",
    ),
    (
        "brick_forgets_those_before",
        views::balls,
        BRICKS,
        "later_brick.wgsl",
        "return load_hit(index);",
        "return Hit(NO_HIT, NO_ID, 0u, 0.0);",
    ),
    (
        "later_brick_never_nearer",
        views::balls,
        BRICKS,
        "trace.wgsl",
        "if (nearest.id != hit.id) {",
        "if (hit.id == NO_ID) {",
    ),
];

const GRIDS: &[Row] = &[
    (
        "first_cell_one_ahead",
        views::balls,
        GRID,
        "grid_ray.wgsl",
        "floor(along.start + along.t_enter * along.speed)",
        "floor(along.start + along.t_enter * along.speed) + along.step",
    ),
    (
        "any_hit_of_a_cell_ends_the_walk",
        views::lattice,
        GRID,
        "grid.wgsl",
        "(*found).t <= t_leave",
        "(*found).place != NO_PLACE",
    ),
    (
        "diagonal_steps",
        views::lattice,
        GRID,
        "grid.wgsl",
        "planes <= vec3f(t_leave)",
        "planes <= vec3f(t_leave + 2.0)",
    ),
    (
        "first_of_a_list_dropped",
        views::balls,
        GRID,
        "list_copied.wgsl",
        "let here = intersect_sphere(ray, sphere).t;",
        "let here = select(intersect_sphere(ray, sphere).t, NO_HIT, at == start);",
    ),
    (
        "first_reference_dropped",
        views::balls,
        REFERENCES,
        "list_referenced.wgsl",
        "let here = intersect_sphere(ray, spheres[candidate]).t;",
        "let here = select(intersect_sphere(ray, spheres[candidate]).t, NO_HIT, at == start);",
    ),
    (
        "empty_cells_overstepped",
        views::clusters,
        GRID,
        "nested_grid.wgsl",
        "f32((word >> octant) & REACH)",
        "f32((word >> octant) & REACH) + 1.0",
    ),
    (
        "inner_cells_one_ahead",
        views::clusters,
        GRID,
        "nested_grid.wgsl",
        "var inner = clamp(there,",
        "var inner = clamp(there + along.step,",
    ),
];

const TREES: &[Row] = &[
    (
        "leaf_slot_dropped",
        views::balls,
        TREE,
        "wide_tree.wgsl",
        "leaves = node.hits & ~node.inner_mask;",
        "leaves = node.hits & ~node.inner_mask & 0x7fu;",
    ),
    (
        "boxes_shrunk_by_a_thousandth",
        views::along_an_axis,
        BINARY,
        "binary_node.wgsl",
        "(bitcast<vec3f>(high.xyz) - ray.origin)",
        "(bitcast<vec3f>(high.xyz) - 0.001 * abs(bitcast<vec3f>(high.xyz)) - ray.origin)",
    ),
    (
        "boxes_shrunk_by_a_fiftieth",
        views::balls,
        TREE,
        "wide_node.wgsl",
        "bitcast<vec3f>(exponents << vec3u(23u))",
        "0.98 * bitcast<vec3f>(exponents << vec3u(23u))",
    ),
    (
        "octant_order_not_undone",
        views::balls,
        TREE,
        "wide_group.wgsl",
        "(firstTrailingBit(group.y >> 24u)) ^ octant",
        "firstTrailingBit(group.y >> 24u)",
    ),
    (
        "siblings_counted_wrong",
        views::balls,
        TREE,
        "wide_group.wgsl",
        "countOneBits(group.y & ((1u << slot) - 1u))",
        "countOneBits(group.y & ((2u << slot) - 1u))",
    ),
    (
        "stale_stack_entry",
        views::balls,
        BINARY,
        "binary_tree.wgsl",
        "            next = stack[top];",
        "            next = vec2u(stack[top].x, stack[0].y);",
    ),
    (
        "far_child_not_pushed",
        views::balls,
        BINARY,
        "binary_tree.wgsl",
        "            stack[top] = far_way;\n            top++;",
        "            stack[top] = far_way;",
    ),
    (
        "leaves_pruned_too_soon",
        views::balls,
        BINARY,
        "binary_tree.wgsl",
        "child.entry <= (*nearest).t",
        "child.entry + 0.3 <= (*nearest).t",
    ),
    (
        "descending_rays_enter_at_the_exit",
        views::balls,
        BINARY,
        "binary_node.wgsl",
        "let near = min(a, b);",
        "let near = a;",
    ),
];

const SCHEDULE: &[Row] = &[
    (
        "seam_of_one_row",
        views::balls,
        LIST,
        "trace.wgsl",
        "if (any(pixel >= frame.tile_size)) {",
        "if (any(pixel >= frame.tile_size) || pixel.y == 41u) {",
    ),
    (
        "one_pixel_not_traced",
        views::balls,
        LIST,
        "trace.wgsl",
        "if (any(pixel >= frame.tile_size)) {",
        "if (any(pixel >= frame.tile_size) || all(pixel == vec2u(47u, 40u))) {",
    ),
    (
        "rows_of_groups_in_the_wrong_place",
        views::balls,
        LIST,
        "schedule.wgsl",
        "let row = remainder(ordinal, frame.traced_size.y);",
        "let row = group.y / 2u;",
    ),
    (
        "lanes_collide",
        views::balls,
        LIST,
        "schedule.wgsl",
        "every_second_bit(lane >> 1u)",
        "every_second_bit(lane >> 3u)",
    ),
    (
        "hits_of_the_pixel_before",
        views::balls,
        LIST,
        "frame.wgsl",
        "let bits = hits[index];",
        "let bits = hits[max(index, 1u) - 1u];",
    ),
    (
        "every_tile_shows_the_first",
        views::two_tiles,
        LIST,
        "entry_recorded.wgsl",
        "frame.tile_origin + pixel_in_tile",
        "pixel_in_tile",
    ),
];
