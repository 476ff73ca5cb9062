//! Why a selection cannot be read, or does not apply to the data.

use crate::color_by::ColumnError;

/// Why a selection cannot be read, or does not apply to the data.
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
        /// What is wrong.
        problem: SelectProblem,
    },
    /// No sphere matches.
    #[error("`{expression}` selects none of the {of} spheres{hint}")]
    Nothing {
        /// The expression.
        expression: String,
        /// The number of spheres.
        of: usize,
        /// What may be the reason, after a semicolon; empty if it is not known.
        hint: String,
    },
}

/// What is wrong with a part of an expression.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SelectProblem {
    /// A column is missing in the data.
    #[error(transparent)]
    Column(#[from] ColumnError),
    /// Something is missing at this place.
    #[error("{wanted} belongs here, but {found} stands here")]
    Wanted {
        /// What belongs here.
        wanted: &'static str,
        /// What stands here.
        found: String,
    },
    /// A quotation mark, a bar or a parenthesis has no partner.
    #[error("there is no closing {0}")]
    Unclosed(char),
    /// A single `=`.
    #[error("write == to compare")]
    SingleEqual,
    /// A single `&` or `|`.
    #[error("write {0}{0}, or the word")]
    Single(char),
    /// Two comparisons share a side.
    #[error("a comparison has two sides; join two comparisons with `and`, such as 1 < z and z < 3")]
    Chain,
    /// Parentheses and negations are too deep.
    #[error("parentheses lie in more than {0} others; simplify the expression")]
    TooDeep(usize),
    /// A text is compared with numbers.
    #[error("`{text}` is a text, but `{column}` holds numbers")]
    TextForNumbers {
        /// The text.
        text: String,
        /// What it is compared with.
        column: String,
    },
    /// The order of texts was asked for.
    #[error("`{column}` holds text, which is compared only with == and !=, or with a number")]
    OrderOfText {
        /// The name of the column.
        column: String,
    },
    /// Two columns of text are compared.
    #[error(
        "`{0}` is a column of text, too, and columns of text are compared only with texts; put quotation marks around a \
         text"
    )]
    TwoTexts(String),
    /// Neither side is a column.
    #[error(
        "this compares two fixed values; one of them must be a column, without quotation marks"
    )]
    NoColumn,
}
