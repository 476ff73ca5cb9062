//! Reads TOML more strictly than serde does: serde accepts lists in place of tables, and ignores surplus elements of
//! arrays.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, Expected, MapAccess, SeqAccess, Visitor};

/// Reads all elements of a list, which must have exactly `N`.
///
/// # Errors
/// If there are more or fewer, or one is of another type.
pub fn elements<'de, A: SeqAccess<'de>, T: Deserialize<'de> + Copy + Default, const N: usize>(
    mut seq: A,
    expected: &dyn Expected,
) -> Result<[T; N], A::Error> {
    let mut elements = [T::default(); N];
    let mut count = 0;
    while let Some(element) = seq.next_element()? {
        if let Some(place) = elements.get_mut(count) {
            *place = element;
        }
        count += 1;
    }
    if count == N { Ok(elements) } else { Err(Error::invalid_length(count, expected)) }
}

/// Reads a list of exactly `N` numbers.
///
/// # Errors
/// If it is another value.
pub fn array<'de, D: Deserializer<'de>, const N: usize>(deserializer: D) -> Result<[f64; N], D::Error> {
    struct Numbers<const N: usize>;

    impl<'de, const N: usize> Visitor<'de> for Numbers<N> {
        type Value = [f64; N];

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "a list of {N} numbers")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<[f64; N], A::Error> {
            elements(seq, &self)
        }
    }

    deserializer.deserialize_seq(Numbers)
}

/// A list of exactly `N` numbers.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct List<const N: usize>(#[serde(deserialize_with = "array")] pub [f64; N]);

impl<const N: usize> serde::Serialize for List<N> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.as_slice().serialize(serializer)
    }
}

/// A value that must be a table in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
#[serde(transparent)]
pub struct Table<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Table<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Map<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Map<T> {
            type Value = Table<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Table<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(Table)
            }
        }

        deserializer.deserialize_map(Map(PhantomData))
    }
}

/// An angle that is in radians here and in degrees in a file.
pub mod degrees {
    use serde::{Deserialize, Deserializer, Serializer};

    /// Writes an angle in degrees from which the same radians are read.
    ///
    /// # Errors
    /// If the serializer fails.
    pub fn serialize<S: Serializer>(radians: &f32, serializer: S) -> Result<S::Ok, S::Error> {
        let is_same = |found: f64| (found as f32).to_bits() == radians.to_bits();
        serializer.serialize_f64(of(f64::from(*radians), is_same))
    }

    /// Reads an angle in degrees.
    ///
    /// # Errors
    /// If it is not a number.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
        f64::deserialize(deserializer).map(|degrees| degrees.to_radians() as f32)
    }

    /// An angle in degrees from which `is_same` finds the same radians: a round number if one does.
    pub fn of(radians: f64, is_same: impl Fn(f64) -> bool) -> f64 {
        let exact = radians.to_degrees();
        let round = [1e2, 1e6, 1e9].map(|digits| (exact * digits).round() / digits);
        let near = [exact, exact.next_up(), exact.next_down()];
        let further = [exact.next_up().next_up(), exact.next_down().next_down()];
        let all = round.into_iter().chain(near).chain(further);
        all.into_iter().find(|degrees| is_same(degrees.to_radians())).unwrap_or(exact)
    }
}
