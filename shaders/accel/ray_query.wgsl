// Search by ray queries: the driver has built a structure from boxes, in hardware or not, and says which of them a ray
// may meet. What it may miss is unknown, so the boxes have margins, and the certificate says whether they suffice.
// provides: find_any, find_nearest
// needs: NO_HIT, Nearest, Search, distance_within, offer, spend

enable wgpu_ray_query;

// The structure of the boxes. Their indices are those of `shapes`.
@group(1) @binding(3) var boxes: acceleration_structure;

fn query_of(search: Search, t_max: f32) -> RayDesc {
    return RayDesc(RAY_FLAG_NONE, 0xffu, 0.0, t_max, search.ray.origin, search.ray.direction);
}

fn find_nearest(search: Search, nearest: ptr<function, Nearest>) {
    var query: ray_query;
    rayQueryInitialize(&query, boxes, query_of(search, (*nearest).t));
    while (rayQueryProceed(&query)) {
        if (!spend(1u)) {
            return;
        }
        let before = (*nearest).t;
        let shape_index = rayQueryGetCandidateIntersection(&query).primitive_index;
        offer(nearest, distance_within(search, shape_index, NO_HIT), shape_index);
        // The driver skips boxes behind this. A box begins a margin before its sphere, so that equal distances are met.
        let t = (*nearest).t;
        if (t < before) {
            rayQueryGenerateIntersection(&query, t);
        }
    }
}

fn find_any(search: Search, t_max: f32) -> bool {
    var query: ray_query;
    rayQueryInitialize(&query, boxes, query_of(search, t_max));
    while (rayQueryProceed(&query)) {
        if (!spend(1u)) {
            return false;
        }
        let shape_index = rayQueryGetCandidateIntersection(&query).primitive_index;
        if (distance_within(search, shape_index, t_max) < t_max) {
            return true;
        }
    }
    return false;
}
