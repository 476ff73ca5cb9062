//! Rules of the code that a search of its text can check. This crate has only tests, needs no GPU and builds in
//! seconds, because it does not use the code that it checks.
#![cfg(test)]

mod budgets;
mod circles;
mod invariants;
mod sources;
