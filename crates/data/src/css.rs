//! Reads colours as CSS writes them.

use pinhole::LinearRgb;
use pinhole::internals::text::shortened;

/// Reads a CSS colour: a name, `#rgb`, `#rrggbb`, `rgb(…)` and the other forms of CSS Color 4, all rounded to eight bits
/// of sRGB.
///
/// # Errors
/// Returns an error if the text is not a valid colour, or the colour is not opaque.
pub fn color(text: &str) -> Result<LinearRgb, CssError> {
    let refused = |what| CssError(format!("`{}` is not {what}", shortened(text)));
    let color = csscolorparser::parse(text)
        .map_err(|_| refused("a valid color; write a CSS name, \"#rrggbb\" or a linear triple [r, g, b]"))?;
    if color.a < 1.0 {
        return Err(refused("opaque; a color here cannot have alpha"));
    }
    let [r, g, b, _] = color.to_rgba8();
    Ok(LinearRgb::from_srgb8([r, g, b]))
}

/// The reason why a text is not an opaque CSS colour.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct CssError(String);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn css_names_and_hex_are_the_same_bytes() {
        for (text, bytes) in [
            ("powderblue", [0xb0, 0xe0, 0xe6]),
            ("#b0e0e6", [0xb0, 0xe0, 0xe6]),
            ("green", [0, 0x80, 0]),
            ("#F00", [255, 0, 0]),
        ] {
            assert_eq!(color(text).unwrap(), LinearRgb::from_srgb8(bytes), "{text}");
        }
        for (text, words) in [("gren", "is not a valid color"), ("#ff000080", "is not opaque")] {
            assert!(color(text).unwrap_err().to_string().contains(words), "{text}");
        }
    }
}
