//! The reason why a selection cannot be read, or does not apply to the data.

use pinhole::internals::text::one_line;

/// The reason why a selection cannot be read, or does not apply to the data.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SelectError {
    /// A part of the expression is wrong.
    #[error("character {character} of `{expression}`: {problem}")]
    At {
        /// The expression.
        expression: String,
        /// The character at which the wrong part begins, counted from 1.
        character: usize,
        /// Description of the fault.
        problem: String,
    },
    /// No sphere matches.
    #[error("`{expression}` selects none of the {of} spheres{hint}")]
    Nothing {
        /// The expression.
        expression: String,
        /// The number of spheres.
        of: usize,
        /// A possible reason, after a semicolon; empty if none is known.
        hint: String,
    },
}

/// The error that a part of an expression is wrong, which begins at the byte `at`.
pub(super) fn error_at(text: &str, at: usize, problem: impl Into<String>) -> SelectError {
    let character = text.get(..at).unwrap_or_default().chars().count() + 1;
    SelectError::At { expression: one_line(text), character, problem: problem.into() }
}
