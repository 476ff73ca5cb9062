//! Finds which points are near others, by a grid of cells.

use glam::{DVec3, U64Vec3, UVec3};

use crate::cell::PeriodicCell;

/// Points farther from the origin are nowhere: the squares of their distances would overflow.
const FARTHEST: f64 = 1e100;

/// The most cells of a grid, if there are few points.
const MOST_CELLS: usize = 1 << 20;

/// Points sorted into cells whose side is at least the distance within which they are sought.
pub(super) struct Grid {
    low: DVec3,
    /// Cells in a unit of length.
    density: f64,
    counts: UVec3,
    /// The places in `points` where those of each cell start.
    starts: Vec<u32>,
    points: Vec<DVec3>,
    /// Cells that have points or have a neighbour with points.
    marks: Vec<bool>,
    reach: f64,
    cell: Option<PeriodicCell>,
}

/// Returns true if a point is at a place to which distances can be measured.
pub(super) fn is_somewhere(point: DVec3) -> bool {
    point.abs().max_element() < FARTHEST && !point.is_nan()
}

impl Grid {
    /// Sorts points, and their images if there is a cell. Returns `None` if there are too many images.
    pub(super) fn new(points: impl Iterator<Item = DVec3>, reach: f64, cell: Option<PeriodicCell>) -> Option<Self> {
        // Farther than any two points are apart, and its square does not overflow.
        let reach = reach.min(1e3 * FARTHEST);
        let mut all: Vec<DVec3> = points.filter(|point| is_somewhere(*point)).collect();
        if let Some(cell) = &cell {
            for point in &mut all {
                *point = cell.moved(*point, -cell.turns(*point));
            }
            let images = cell.images(&all, reach)?;
            all.extend(
                images.iter().map(|(index, shift)| cell.moved(all[*index as usize], *shift)).collect::<Vec<_>>(),
            );
        }
        let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let [low, high] = all.iter().fold(empty, |[low, high], point| [low.min(*point), high.max(*point)]);
        let size = if all.is_empty() { DVec3::ZERO } else { high - low };
        // Wider than the distance by more than rounding.
        let mut side = (1.000_001 * reach).max(1e-3 * size.max_element()).max(1e-30);
        let most = MOST_CELLS.max(4 * all.len()).min(1 << 31) as f64;
        while (size / side + 3.0).floor().element_product() > most {
            side *= 1.25;
        }
        let low = if all.is_empty() { DVec3::ZERO } else { low - side };
        let counts = (size / side + 3.0).floor().as_uvec3();
        let mut grid = Self {
            low,
            density: 1.0 / side,
            counts,
            starts: vec![0; counts.as_u64vec3().element_product() as usize + 1],
            points: vec![DVec3::ZERO; all.len()],
            marks: Vec::new(),
            reach,
            cell,
        };
        grid.sort(&all);
        grid.mark();
        Some(grid)
    }

    /// The cell of a point; `None` if it is outside the grid.
    fn place(&self, point: DVec3) -> Option<U64Vec3> {
        let place = ((point - self.low) * self.density).floor();
        let is_inside = place.cmpge(DVec3::ZERO).all() && place.cmplt(self.counts.as_dvec3()).all();
        is_inside.then(|| place.as_u64vec3())
    }

    fn index(&self, place: U64Vec3) -> usize {
        let [width, height, _] = self.counts.as_u64vec3().to_array();
        (place.x + width * (place.y + height * place.z)) as usize
    }

    fn sort(&mut self, all: &[DVec3]) {
        let places: Vec<u32> = all.iter().map(|p| self.place(*p).map_or(0, |place| self.index(place) as u32)).collect();
        for place in &places {
            self.starts[*place as usize + 1] += 1;
        }
        for index in 1..self.starts.len() {
            self.starts[index] += self.starts[index - 1];
        }
        let mut next = self.starts.clone();
        for (point, place) in all.iter().zip(places) {
            let next = &mut next[place as usize];
            self.points[*next as usize] = *point;
            *next += 1;
        }
    }

    fn mark(&mut self) {
        self.marks = self.starts.windows(2).map(|ends| ends[0] < ends[1]).collect();
        let [width, height, _] = self.counts.to_array().map(|count| count as usize);
        // One direction after the other.
        for step in [1, width, width * height] {
            let before = self.marks.clone();
            for (index, mark) in self.marks.iter_mut().enumerate() {
                let next = |other: usize| before.get(other).copied().unwrap_or(false);
                *mark = *mark || next(index.wrapping_sub(step)) || next(index + step);
            }
        }
    }

    /// The points of the 27 cells around a point that is not far away from all. Points of neighbours along x follow each
    /// other.
    fn around(&self, point: DVec3) -> impl Iterator<Item = &[DVec3]> {
        let place = self.place(point).filter(|place| self.marks[self.index(*place)]);
        let rows = place.into_iter().flat_map(move |place| {
            let [y, z] = [(place.y, self.counts.y), (place.z, self.counts.z)]
                .map(|(at, count)| at.saturating_sub(1)..(at + 2).min(count.into()));
            z.flat_map(move |z| y.clone().map(move |y| (place.x, y, z)))
        });
        rows.map(|(x, y, z)| {
            let row = self.index(U64Vec3::new(0, y, z));
            let [start, end] = [x.saturating_sub(1), (x + 2).min(self.counts.x.into())].map(|x| row + x as usize);
            &self.points[self.starts[start] as usize..self.starts[end] as usize]
        })
    }

    /// Returns true if one of the points is at most the distance away.
    pub(super) fn has_near(&self, point: DVec3) -> bool {
        let point = self.in_cell(point);
        let most = self.reach * self.reach;
        self.around(point).any(|points| points.iter().any(|other| other.distance_squared(point) <= most))
    }

    /// The squared distance to the nearest of the points that are at most the distance away.
    pub(super) fn nearest(&self, point: DVec3) -> Option<f64> {
        let point = self.in_cell(point);
        let squared = self.around(point).flatten().map(|other| other.distance_squared(point));
        squared.reduce(f64::min).filter(|squared| *squared <= self.reach * self.reach)
    }

    fn in_cell(&self, point: DVec3) -> DVec3 {
        self.cell.as_ref().map_or(point, |cell| cell.moved(point, -cell.turns(point)))
    }
}
