//! Divides spheres among bricks.

/// Parts of about the same number of spheres, each in a box of its own but for what sticks out, in an
/// order of ids: at the median of the longest side, again and again.
pub(super) fn divide(spheres: &[[f32; 4]], parts: usize) -> Vec<Vec<u32>> {
    let mut ids: Vec<u32> = (0..spheres.len() as u32).collect();
    let mut bricks = Vec::with_capacity(parts);
    cut(spheres, &mut ids, parts, &mut bricks);
    bricks
}

fn cut(spheres: &[[f32; 4]], ids: &mut [u32], parts: usize, bricks: &mut Vec<Vec<u32>>) {
    if parts <= 1 {
        let mut brick = ids.to_vec();
        brick.sort_unstable();
        bricks.push(brick);
        return;
    }
    let axis = longest_side(spheres, ids);
    let left_parts = parts / 2;
    let middle = ids.len() * left_parts / parts;
    let by_place = |a: &u32, b: &u32| {
        let along = |id: &u32| spheres[*id as usize][axis];
        along(a).total_cmp(&along(b)).then(a.cmp(b))
    };
    if middle < ids.len() {
        ids.select_nth_unstable_by(middle, by_place);
    }
    let (left, right) = ids.split_at_mut(middle);
    cut(spheres, left, left_parts, bricks);
    cut(spheres, right, parts - left_parts, bricks);
}

fn longest_side(spheres: &[[f32; 4]], ids: &[u32]) -> usize {
    let mut low = [f32::MAX; 3];
    let mut high = [f32::MIN; 3];
    for id in ids {
        for axis in 0..3 {
            let x = spheres[*id as usize][axis];
            low[axis] = low[axis].min(x);
            high[axis] = high[axis].max(x);
        }
    }
    (0..3).max_by(|a, b| (high[*a] - low[*a]).total_cmp(&(high[*b] - low[*b]))).unwrap_or(0)
}
