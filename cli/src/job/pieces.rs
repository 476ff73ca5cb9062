//! A unit in smaller pieces, where the device has not enough memory for all of it.

use super::units::Rectangle;
use crate::failure::Failure;
use crate::speak::tell;
use crate::views::Views;
use pinhole::image::{Image, LayerSet};

/// How often a unit is halved. What does not fit into an eighth of a tile does not fit because of the spheres.
const HALVINGS: u32 = 3;

/// Renders a rectangle at once, or in halves if there is not enough memory, and says so unless it is to be quiet. The
/// pixels are the same.
pub(super) fn render(
    rectangle: Rectangle,
    layers: LayerSet,
    quiet: bool,
    at_once: &mut dyn FnMut(Rectangle) -> Result<Views<Image>, Failure>,
) -> Result<Views<Image>, Failure> {
    let mut is_told = quiet;
    halved(rectangle, layers, HALVINGS, &mut |rectangle| {
        let done = at_once(rectangle);
        if let (Err(failure @ Failure::Memory(_)), false) = (&done, is_told) {
            is_told = true;
            tell(format_args!("note: {}; trying smaller tiles", failure.message()));
        }
        done
    })
}

fn halved(
    (origin, size): Rectangle,
    layers: LayerSet,
    halvings: u32,
    at_once: &mut dyn FnMut(Rectangle) -> Result<Views<Image>, Failure>,
) -> Result<Views<Image>, Failure> {
    let failure = match at_once((origin, size)) {
        Err(Failure::Memory(error)) if halvings > 0 && size[0].max(size[1]) > 1 => {
            Failure::Memory(error)
        }
        done => return done,
    };
    let axis = usize::from(size[1] > size[0]);
    let (mut first, mut last, mut middle) = (size, size, origin);
    first[axis] = size[axis] / 2;
    last[axis] = size[axis] - first[axis];
    middle[axis] += first[axis];
    let mut whole: Option<Views<Image>> = None;
    for (start, size_of_half) in [(origin, first), (middle, last)] {
        let half = halved((start, size_of_half), layers, halvings - 1, at_once)?;
        let whole = match &mut whole {
            Some(whole) => whole,
            None => whole.insert(half.try_each(|_| {
                Image::new(size[0], size[1], layers).map_err(|error| Failure::Job(error.into()))
            })?),
        };
        let place = [start[0] - origin[0], start[1] - origin[1]];
        for (whole, half) in whole.as_mut_slice().iter_mut().zip(half.as_slice()) {
            whole.put(half, place).map_err(|error| Failure::Job(error.into()))?;
        }
    }
    whole.ok_or(failure)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture whose colors say where in the whole film its pixels are.
    fn at((origin, size): Rectangle) -> Views<Image> {
        let places = (0..size[1]).flat_map(|j| (0..size[0]).map(move |i| [i, j]));
        let bytes = places.flat_map(|[i, j]| {
            [(origin[0] + i) as f32, (origin[1] + j) as f32, 0.0].map(f32::to_le_bytes).concat()
        });
        let bytes: Vec<u8> = bytes.collect();
        Views::One(Image::from_le_bytes(size, LayerSet::COLOR, &bytes).unwrap())
    }

    #[test]
    fn halves_make_the_whole() {
        let whole = ([5, 7], [23, 18]);
        for most in [1000, 414, 413, 200, 60] {
            let mut tries = 0;
            let mut at_once = |rectangle: Rectangle| {
                tries += 1;
                let [width, height] = rectangle.1;
                match width * height > most {
                    true => Err(Failure::Memory(anyhow::anyhow!("too large"))),
                    false => Ok(at(rectangle)),
                }
            };
            let found = render(whole, LayerSet::COLOR, true, &mut at_once).unwrap();
            assert_eq!(found.as_slice(), at(whole).as_slice(), "{most}");
            assert_eq!(tries == 1, most >= 414, "{most}");
        }
        let never = &mut |_| Err(Failure::Memory(anyhow::anyhow!("too large")));
        assert!(matches!(render(whole, LayerSet::COLOR, true, never), Err(Failure::Memory(_))));
        let pixel = &mut |_| Err(Failure::Memory(anyhow::anyhow!("too large")));
        assert!(render(([0, 0], [1, 1]), LayerSet::COLOR, true, pixel).is_err());
    }
}
