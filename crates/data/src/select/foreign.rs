//! Recognises selections in the languages of other programs that this one does not speak, to say what to write.

/// Returns what to write in the place of a selection of `ChimeraX` or NGL. The text starts with a part that no selection of
/// this language starts with.
pub(super) fn remedy(text: &str) -> Option<String> {
    if let Some(attribute) = text.strip_prefix("@@") {
        let end = attribute.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
        let (name, rest) = attribute.split_at(end);
        let sign_end = rest.find(|c: char| !"<>=!".contains(c)).filter(|end| *end > 0)?;
        let (sign, value) = rest.split_at(sign_end);
        let value = value.split_whitespace().next()?;
        let name = crate::keys::key_of(name).map_or(name, |key| key.name);
        return Some(format!("this is ChimeraX's; write: {name} {sign} {value}"));
    }
    if let Some(terms) = macro_terms(text) {
        return Some(format!("this is PyMOL's; write: {terms}"));
    }
    let is_chimera = text.starts_with(['/', '#', '@'])
        || text.strip_prefix(':').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    let is_ngl = text.starts_with([':', '.']) && !is_chimera;
    let mut words = Vec::new();
    for word in text.split_whitespace() {
        match word {
            "and" | "or" | "not" => words.push(word.to_owned()),
            _ => words.push(parts(word, is_ngl)?.join(" and ")),
        }
    }
    let whose = if is_ngl { "NGL's" } else { "ChimeraX's" };
    (is_chimera || is_ngl).then(|| format!("this is {whose}; write: {}", words.join(" ")))
}

/// The terms of a macro such as `/4hhb//A/1-20/CA`: an object, a segment, a chain, residues and names.
fn macro_terms(text: &str) -> Option<String> {
    let parts: Vec<&str> = text.strip_prefix('/')?.split('/').collect();
    let is_macro = (3..=5).contains(&parts.len()) && !text.contains([' ', ':', '@']);
    let keys = [None, Some("segid"), Some("chain"), Some("resid"), Some("name")];
    let term = |(key, value): (Option<&str>, &&str)| {
        let value = value.split('`').next().filter(|value| !["", "*"].contains(value))?;
        Some(format!("{} {}", key?, value.replace('+', " ").replace('-', " to ")))
    };
    let terms: Vec<String> = keys.into_iter().zip(&parts).filter_map(term).collect();
    (is_macro && !terms.is_empty()).then(|| terms.join(" and "))
}

/// The terms of a word such as `/A:12-20@CA`.
fn parts(word: &str, is_ngl: bool) -> Option<Vec<String>> {
    let signs: Vec<usize> = word.char_indices().filter(|(_, c)| "/:@.#".contains(*c)).map(|(at, _)| at).collect();
    if signs.first() != Some(&0) {
        return None;
    }
    let ends = signs.iter().skip(1).copied().chain([word.len()]);
    let part = |(start, end): (&usize, usize)| {
        let (sign, value) = word.get(*start..end)?.split_at(1);
        let is_number = value.starts_with(|c: char| c.is_ascii_digit());
        let key = match (sign, is_ngl) {
            ("/", false) => "chain",
            ("/", true) | ("#", false) => "model",
            (":", false) => {
                if is_number {
                    "resid"
                } else {
                    "resname"
                }
            }
            (":", true) => "chain",
            ("@", false) | (".", true) => "name",
            _ => return None,
        };
        (!value.is_empty()).then(|| format!("{key} {}", value.replace(',', " ")))
    };
    signs.iter().zip(ends).map(part).collect()
}
