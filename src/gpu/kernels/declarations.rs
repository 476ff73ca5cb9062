//! The names that a part of a kernel declares and uses. WGSL is simple enough to read them from the text.

use std::collections::BTreeSet;

/// The names in a part of a kernel.
#[derive(Debug, Default)]
pub(super) struct Declarations {
    /// Names that the part declares for the whole kernel: functions, structs, constants, bindings and variables.
    pub(super) global: BTreeSet<String>,
    /// Names of the private variables among them.
    pub(super) private_variables: BTreeSet<String>,
    /// Names that the part uses, without its own parameters, fields and local variables.
    pub(super) used: BTreeSet<String>,
}

impl Declarations {
    pub(super) fn of(source: &str) -> Self {
        let code: String = source
            .lines()
            .map(|line| line.split("//").next().unwrap_or_default())
            .flat_map(|line| [line, "\n"])
            .collect();
        let tokens = tokens(&code);
        let mut found = Self::default();
        let mut local = BTreeSet::new();
        let mut depth = 0;
        for (at, token) in tokens.iter().enumerate() {
            let next = tokens.get(at + 1).copied().unwrap_or_default();
            match *token {
                "{" => depth += 1,
                "}" => depth -= 1,
                "fn" | "struct" | "alias" | "const" | "override" if depth == 0 => {
                    found.global.insert(next.to_owned());
                }
                "var" if depth == 0 => {
                    // Declarations such as `var<private> name: T`.
                    let end = tokens[at..].iter().position(|token| *token == ">").unwrap_or(0);
                    let end = if next == "<" { at + end + 1 } else { at + 1 };
                    let name = tokens[end].to_owned();
                    if tokens[at..end].contains(&"private") {
                        found.private_variables.insert(name.clone());
                    }
                    found.global.insert(name);
                }
                "let" | "var" | "const" => {
                    local.insert(next.to_owned());
                }
                name if next == ":" && is_name(name) => {
                    local.insert(name.to_owned());
                }
                name if is_name(name) && (at == 0 || !matches!(tokens[at - 1], "." | "@")) => {
                    found.used.insert(name.to_owned());
                }
                _ => {}
            }
        }
        // A name that is declared for the whole kernel is not a local name, even if `:` follows it.
        let own: BTreeSet<String> = local.difference(&found.global).cloned().collect();
        found.used = &(&found.used - &own) - &found.global;
        found
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

/// Splits text into tokens: names and numbers are single tokens, and all other characters are tokens of their own.
fn tokens(code: &str) -> Vec<&str> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let end = if is_word(first) { rest.find(|c| !is_word(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
        let (token, behind) = rest.split_at(end);
        tokens.push(token);
        rest = behind.trim_start();
    }
    tokens
}

#[test]
fn names_are_told_apart() {
    let part = "
        // used_in_comment
        struct Pair { first: Other, second: f32, }
        @group(0) @binding(1) var<storage, read> items: array<Pair>;
        var<private> count: u32;
        const SIZE: u32 = 4u;
        fn sum(by: f32) -> f32 {
            let x = items[SIZE].second + helper(by, by).field;
            for (var i = 0u; i < LIMIT; i++) { count += i; }
            return x;
        }";
    let found = Declarations::of(part);
    let set = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<BTreeSet<_>>();
    assert_eq!(found.global, set(&["Pair", "SIZE", "count", "items", "sum"]));
    assert_eq!(found.private_variables, set(&["count"]));
    let names = found.used.iter().filter(|name| ["Other", "helper", "LIMIT"].contains(&name.as_str()));
    assert_eq!(names.count(), 3);
    for foreign in ["used_in_comment", "field", "by", "x", "i", "second"] {
        assert!(!found.used.contains(foreign), "{foreign}");
    }
}
