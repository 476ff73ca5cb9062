//! Removes unreachable code from a kernel, given the values of its `override` constants, before a driver translates it.
//! Otherwise a driver would work on all cameras, materials and sources to find that only one of each is used.

use wgpu::naga::back::pipeline_constants::process_overrides;
use wgpu::naga::compact::{KeepUnused, compact};
use wgpu::naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use wgpu::naga::{
    Block, Expression, Function, Handle, Literal, Module, ShaderStage, Statement, SwitchCase, SwitchValue, front,
};

/// The module of a kernel without `override` constants and without branches that are not taken. `None` if the source is
/// not valid: the device then gives a better error.
pub(super) fn folded(source: &str, entry_point: &str, constants: &[(&str, f64)]) -> Option<Module> {
    let module = front::wgsl::parse_str(source).ok()?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).ok()?;
    folded_module(&module, &info, entry_point, constants)
}

/// The module with these values of its constants.
pub(crate) fn folded_module(
    module: &Module,
    info: &ModuleInfo,
    entry_point: &str,
    constants: &[(&str, f64)],
) -> Option<Module> {
    let values = constants.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let entry_point = Some((ShaderStage::Compute, entry_point));
    let (module, _) = process_overrides(module, info, entry_point, &values).ok()?;
    let mut module = module.into_owned();
    let mut functions = std::mem::take(&mut module.functions);
    functions.iter_mut().for_each(|(_, function)| fold_function(&module, function));
    module.functions = functions;
    let mut entry_points = std::mem::take(&mut module.entry_points);
    entry_points.iter_mut().for_each(|entry| fold_function(&module, &mut entry.function));
    module.entry_points = entry_points;
    compact(&mut module, KeepUnused::No);
    Some(module)
}

fn fold_function(module: &Module, function: &mut Function) {
    let expressions = &function.expressions;
    let known = |handle: Handle<Expression>| match expressions[handle] {
        Expression::Literal(literal) => Some(literal),
        Expression::Constant(constant) => match module.global_expressions[module.constants[constant].init] {
            Expression::Literal(literal) => Some(literal),
            _ => None,
        },
        _ => None,
    };
    fold(&mut function.body, &known);
    // Names would keep values that were computed in a removed branch.
    function.named_expressions.clear();
}

/// Removes the branches of a block that are not taken, and the statements after a jump.
fn fold(block: &mut Block, known: &impl Fn(Handle<Expression>) -> Option<Literal>) {
    for (statement, span) in std::mem::take(block).span_into_iter() {
        let mut statement = taken(statement, known);
        match &mut statement {
            Statement::Block(inner) => fold(inner, known),
            Statement::If { accept, reject, .. } => {
                fold(accept, known);
                fold(reject, known);
            }
            Statement::Switch { cases, .. } => {
                cases.iter_mut().for_each(|case| fold(&mut case.body, known));
            }
            Statement::Loop { body, continuing, .. } => {
                fold(body, known);
                fold(continuing, known);
            }
            _ => {}
        }
        let jumps = jumps(&statement);
        block.push(statement, span);
        if jumps {
            break;
        }
    }
}

/// The branch that is taken, if it is known.
fn taken(statement: Statement, known: &impl Fn(Handle<Expression>) -> Option<Literal>) -> Statement {
    match statement {
        Statement::If { condition, accept, reject } => match known(condition) {
            Some(Literal::Bool(true)) => Statement::Block(accept),
            Some(Literal::Bool(false)) => Statement::Block(reject),
            _ => Statement::If { condition, accept, reject },
        },
        Statement::Switch { selector, mut cases } => {
            if let Some(Literal::U32(value)) = known(selector) {
                let is = |wanted: SwitchValue| move |case: &SwitchCase| case.value == wanted;
                let first = cases.iter().position(is(SwitchValue::U32(value)));
                let first = first.or_else(|| cases.iter().position(is(SwitchValue::Default)));
                let first = first.unwrap_or_default();
                let mut body = Block::new();
                for case in cases.drain(..).skip(first) {
                    body.extend_block(case.body);
                    if !case.fall_through {
                        break;
                    }
                }
                // It stays a switch, because it may have a `break`.
                let value = SwitchValue::Default;
                cases.push(SwitchCase { value, body, fall_through: false });
            }
            Statement::Switch { selector, cases }
        }
        other => other,
    }
}

/// Whether no statement after this one is reached.
fn jumps(statement: &Statement) -> bool {
    match statement {
        Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue => true,
        Statement::Block(block) => block.last().is_some_and(jumps),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "
        override KIND: u32;
        override DOUBLES: bool;
        @group(0) @binding(0) var<storage, read_write> result: array<u32>;
        fn one(x: u32) -> u32 { return x + 1u; }
        fn other(x: u32) -> u32 { let y = x * x; return y; }
        @compute @workgroup_size(1) fn run(@builtin(local_invocation_index) i: u32) {
            var x = i;
            switch KIND {
                case 0u: { x = one(x); }
                case 1u, 2u: { if x == 3u { break; } x = other(x); }
                default: { return; }
            }
            if DOUBLES { x *= 2u; } else { let gone = one(x); x = gone; }
            result[i] = x;
        }";

    fn functions(kind: u32, doubles: bool) -> (Vec<String>, usize) {
        let constants = [("KIND", f64::from(kind)), ("DOUBLES", f64::from(u8::from(doubles)))];
        let module = folded(SOURCE, "run", &constants).unwrap();
        let all = Capabilities::empty();
        Validator::new(ValidationFlags::all(), all).validate(&module).unwrap();
        let names = module.functions.iter().filter_map(|(_, function)| function.name.clone());
        (names.collect(), module.entry_points[0].function.body.len())
    }

    #[test]
    fn only_what_is_reached_is_left() {
        assert_eq!(functions(0, true).0, ["one"]);
        assert_eq!(functions(1, true).0, ["other"]);
        assert_eq!(functions(2, false).0, ["one", "other"]);
        assert!(functions(7, true).0.is_empty());
        // Sources that cannot be parsed are left to the device.
        assert!(folded("fn run() { nothing(); }", "run", &[]).is_none());
        assert!(folded(SOURCE, "run", &[("KIND", 0.0)]).is_none());
    }
}
