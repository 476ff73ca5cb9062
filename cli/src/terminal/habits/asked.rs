//! Values that are parts of those of other flags, which are made at the end of a command line.

use crate::terminal::failure::Failure;

/// Values that belong to other flags.
#[derive(Default)]
pub(super) struct Asked {
    selections: Vec<String>,
    limits: [Option<String>; 2],
    sides: [Option<String>; 2],
    every: Option<String>,
}

impl Asked {
    /// Takes the value of a flag.
    pub(super) fn take(&mut self, name: &str, value: String) -> Result<(), Failure> {
        match name {
            "exclude" => self.selections.push(format!("not ({value})")),
            "slice" => self.selections.push(slice(&value)?),
            "vmin" => self.limits[0] = Some(value),
            "vmax" => self.limits[1] = Some(value),
            "width" => self.sides[0] = Some(value),
            "height" => self.sides[1] = Some(value),
            _ => self.every = Some(value),
        }
        Ok(())
    }

    /// The flags for all values that were taken. `given` takes away the value of a flag that was given itself.
    pub(super) fn flags(
        self,
        mut given: impl FnMut(&str) -> Option<String>,
    ) -> Result<Vec<(&'static str, String)>, Failure> {
        let Self { selections, limits, sides, every } = self;
        let mut flags = Vec::new();
        if !selections.is_empty() {
            let given = given("select").map(|text| format!("({text})"));
            flags.push(("select", given.into_iter().chain(selections).collect::<Vec<_>>().join(" and ")));
        }
        if let Some(every) = every {
            let frames = given("frames").filter(|text| text != "all").unwrap_or_else(|| ":".to_owned());
            flags.push(("frames", format!("{frames}:{every}")));
        }
        if limits.iter().any(Option::is_some) {
            flags.push(("range", limits.map(Option::unwrap_or_default).join(",")));
        }
        match sides {
            [None, None] => {}
            [Some(width), None] => flags.push(("size", width)),
            [Some(width), Some(height)] => flags.push(("size", format!("{width}x{height}"))),
            [None, Some(height)] => {
                let number = height.parse::<u32>().ok().filter(|height| *height < u32::MAX / 4);
                let number =
                    number.ok_or_else(|| Failure::usage(format!("--height {height}: write a whole number")))?;
                flags.push(("size", format!("{}x{number}", number * 4 / 3)));
            }
        }
        Ok(flags)
    }
}

/// The selection for `z=3:9`, of which either end may be left out, or for a comparison.
fn slice(text: &str) -> Result<String, Failure> {
    if text.contains(['<', '>']) {
        return Ok(text.to_owned());
    }
    let parts = text.split_once('=').and_then(|(axis, ends)| Some((axis, ends.split_once(':')?)));
    match parts {
        Some((axis, (low, ""))) if !low.is_empty() => Ok(format!("{axis} >= {low}")),
        Some((axis, ("", high))) if !high.is_empty() => Ok(format!("{axis} <= {high}")),
        Some((axis, (low, high))) if !low.is_empty() => Ok(format!("{low} <= {axis} <= {high}")),
        _ => Err(Failure::usage(format!(
            "--slice {text}: write AXIS=LOW:HIGH, such as z=3:9, which keeps whole spheres"
        ))),
    }
}
