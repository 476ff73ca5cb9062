//! Rules of the code that a search of its text can guard. They are tests alone, need no GPU and build in seconds, because
//! they do not use what they guard.
#![cfg(test)]

mod budgets;
mod circles;
mod invariants;
mod sources;
