//! How a table of a file joins that of its style.

use toml::Spanned;

use crate::exact::Table;

/// Joins a table of a file with that of its style.
pub(super) fn either<T>(
    own: Option<Spanned<Table<T>>>,
    style: Option<Spanned<Table<T>>>,
    over: impl FnOnce(T, T) -> T,
) -> Option<Spanned<Table<T>>> {
    match (own, style) {
        (Some(own), Some(style)) => {
            let (span, style) = (own.span(), style.into_inner().0);
            Some(Spanned::new(span, Table(over(own.into_inner().0, style))))
        }
        (own, style) => own.or(style),
    }
}
