// Choosing an emissive sphere, and finding one by its id. Twin: src/light/emitters.rs.
// provides: chosen_emitter, emitter_density, emitter_with_id
// needs: Emitter, PI, cone_of_sphere, emitter_words, lighting

// The index of the first emitter whose word is at least `value`. Both the ids (word 0) and the largest random number
// that chooses an emitter (word 1) ascend.
fn find_emitter(word: u32, value: u32) -> u32 {
    var low = 0u;
    var count = lighting.emitter_count;
    for (var step = 0u; step < 32u && count > 0u; step++) {
        let half = count >> 1u;
        let words = emitter_words(3u * (low + half) + 1u);
        let is_before = select(words.x, words.y, word == 1u) < value;
        low = select(low, low + half + 1u, is_before);
        count = select(half, count - half - 1u, is_before);
    }
    return min(low, max(lighting.emitter_count, 1u) - 1u);
}

fn emitter_with_id(id: u32) -> u32 {
    return find_emitter(0u, id);
}

fn chosen_emitter(bits: u32) -> u32 {
    return find_emitter(1u, bits);
}

// The density per unit of solid angle with which a point samples directions towards a chosen emitter; 0 from inside.
fn emitter_density(emitter: Emitter, position: vec3f) -> f32 {
    let toward = emitter.sphere.xyz - position;
    let distance = sqrt(dot(toward, toward));
    let k = cone_of_sphere(emitter.sphere.w, max(distance, emitter.sphere.w));
    let density = emitter.probability / (2.0 * PI * k);
    return select(0.0, density, distance > emitter.sphere.w);
}
