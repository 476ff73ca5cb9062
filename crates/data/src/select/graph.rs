//! The graph of bonds, and what bonds connect.

/// The bonds of each sphere.
pub(super) struct Graph {
    /// The places where the neighbours of each sphere start.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Graph {
    pub(super) fn new(count: usize, pairs: &[[u32; 2]]) -> Self {
        let mut starts = vec![0_u32; count + 1];
        for end in pairs.iter().flatten() {
            starts[*end as usize + 1] += 1;
        }
        for index in 1..starts.len() {
            starts[index] += starts[index - 1];
        }
        let mut next = starts.clone();
        let mut neighbours = vec![0; 2 * pairs.len()];
        for (from, to) in pairs.iter().flat_map(|[a, b]| [(a, b), (b, a)]) {
            let next = &mut next[*from as usize];
            neighbours[*next as usize] = *to;
            *next += 1;
        }
        Self { starts, neighbours }
    }

    pub(super) fn neighbours(&self, index: usize) -> &[u32] {
        &self.neighbours[self.starts[index] as usize..self.starts[index + 1] as usize]
    }

    /// The number of bonds of each sphere.
    pub(super) fn counts(&self) -> Vec<f64> {
        self.starts.windows(2).map(|ends| f64::from(ends[1] - ends[0])).collect()
    }

    /// The spheres with a bond to one of those.
    pub(super) fn bonded_to(&self, is_in: &[bool]) -> Vec<bool> {
        let is_bonded = |index: usize| self.neighbours(index).iter().any(|other| is_in[*other as usize]);
        (0..is_in.len()).map(is_bonded).collect()
    }

    /// Those spheres, and the ones that at most this number of bonds away.
    pub(super) fn within(&self, is_in: &[bool], steps: usize) -> Vec<bool> {
        let mut reached = is_in.to_vec();
        let mut edge: Vec<u32> = (0..).zip(is_in).filter(|(_, is_in)| **is_in).map(|(index, _)| index).collect();
        for _ in 0..steps {
            let mut next = Vec::new();
            for index in edge {
                for other in self.neighbours(index as usize) {
                    if !std::mem::replace(&mut reached[*other as usize], true) {
                        next.push(*other);
                    }
                }
            }
            if next.is_empty() {
                break;
            }
            edge = next;
        }
        reached
    }

    /// The number of the connected piece of each sphere, in the order of their first spheres.
    pub(super) fn fragments(&self) -> Vec<u32> {
        let count = self.starts.len() - 1;
        let mut pieces = vec![u32::MAX; count];
        let (mut piece, mut open) = (0, Vec::new());
        for first in 0..count {
            if pieces[first] != u32::MAX {
                continue;
            }
            pieces[first] = piece;
            open.push(first as u32);
            while let Some(index) = open.pop() {
                for other in self.neighbours(index as usize) {
                    if pieces[*other as usize] == u32::MAX {
                        pieces[*other as usize] = piece;
                        open.push(*other);
                    }
                }
            }
            piece += 1;
        }
        pieces
    }
}
