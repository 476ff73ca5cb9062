//! The rewriting of one function, which replaces its operations by calls.

use std::collections::HashMap;

use naga::{
    Arena, BinaryOperator, Block, Expression, Function, Handle, MathFunction, Range, ScalarKind, Span, Statement,
    TypeInner, UniqueArena, VectorSize,
};

use super::ORDERS;

/// The data of a module that rewriting its functions needs.
pub(super) struct Context<'a> {
    pub(super) types: &'a UniqueArena<naga::Type>,
    /// The functions that replace operations, by their names.
    pub(super) operations: &'a HashMap<String, Handle<Function>>,
    /// The seed that chooses among the forms of operations.
    pub(super) seed: u64,
    /// The fraction of operations that become calls.
    pub(super) share: f64,
}

pub(super) struct Rewriter<'a> {
    context: &'a Context<'a>,
    old: &'a Function,
    info: &'a naga::valid::FunctionInfo,
    new: Arena<Expression>,
    /// The new expression of each old one, by index.
    map: Vec<Option<Handle<Expression>>>,
    /// Whether a statement emits an old expression.
    is_emitted: Vec<bool>,
    /// The first and the last expression that are not yet emitted.
    pending: Option<(Handle<Expression>, Handle<Expression>)>,
    random: fastrand::Rng,
}

impl<'a> Rewriter<'a> {
    /// Returns the function with calls in place of its operations.
    pub(super) fn rewrite(
        context: &'a Context<'a>,
        old: &'a Function,
        info: &'a naga::valid::FunctionInfo,
    ) -> Function {
        let length = old.expressions.len();
        let name = old.name.as_deref().unwrap_or_default();
        let seed = super::seed_of(name, context.seed);
        let mut rewriter = Self {
            context,
            old,
            info,
            new: Arena::new(),
            map: vec![None; length],
            is_emitted: vec![false; length],
            pending: None,
            random: fastrand::Rng::with_seed(seed),
        };
        rewriter.mark_emitted(&old.body);
        // Expressions that no statement emits have only operands of the same kind.
        for (handle, expression) in old.expressions.iter() {
            if !rewriter.is_emitted[handle.index()] {
                let mapped = rewriter.mapped(expression);
                rewriter.map[handle.index()] = Some(rewriter.new.append(mapped, Span::UNDEFINED));
            }
        }
        let body = rewriter.block(&old.body);
        let local_variables = rewriter.local_variables();
        Function {
            name: old.name.clone(),
            arguments: old.arguments.clone(),
            result: old.result.clone(),
            local_variables,
            expressions: rewriter.new,
            named_expressions: Default::default(),
            body,
            diagnostic_filter_leaf: old.diagnostic_filter_leaf,
        }
    }

    fn local_variables(&self) -> Arena<naga::LocalVariable> {
        let mut variables = Arena::new();
        for (_, variable) in self.old.local_variables.iter() {
            let init = variable.init.map(|init| self.of(init));
            variables.append(naga::LocalVariable { init, ..variable.clone() }, Span::UNDEFINED);
        }
        variables
    }

    fn mark_emitted(&mut self, block: &Block) {
        for statement in block {
            match statement {
                Statement::Emit(range) => {
                    range.clone().for_each(|handle| self.is_emitted[handle.index()] = true);
                }
                Statement::Block(inner) => self.mark_emitted(inner),
                Statement::If { accept, reject, .. } => {
                    self.mark_emitted(accept);
                    self.mark_emitted(reject);
                }
                Statement::Switch { cases, .. } => {
                    cases.iter().for_each(|case| self.mark_emitted(&case.body));
                }
                Statement::Loop { body, continuing, .. } => {
                    self.mark_emitted(body);
                    self.mark_emitted(continuing);
                }
                _ => {}
            }
        }
    }

    fn of(&self, old: Handle<Expression>) -> Handle<Expression> {
        self.map[old.index()].unwrap_or_else(|| panic!("{:?} is not there yet", self.old.expressions[old]))
    }

    fn block(&mut self, old: &Block) -> Block {
        let mut new = Block::new();
        for statement in old {
            let statement = self.statement(statement, &mut new);
            self.end_emit(&mut new);
            if let Some(statement) = statement {
                new.push(statement, Span::UNDEFINED);
            }
        }
        new
    }

    /// Rewrites a statement. Statements that emit expressions are pushed to the block.
    fn statement(&mut self, old: &Statement, block: &mut Block) -> Option<Statement> {
        let mut new = old.clone();
        match &mut new {
            Statement::Emit(range) => {
                range.clone().for_each(|handle| self.expression(handle, block));
                return None;
            }
            Statement::Block(inner) => *inner = self.block(inner),
            Statement::If { condition, accept, reject } => {
                *condition = self.of(*condition);
                *accept = self.block(accept);
                *reject = self.block(reject);
            }
            Statement::Switch { selector, cases } => {
                *selector = self.of(*selector);
                cases.iter_mut().for_each(|case| case.body = self.block(&case.body));
            }
            Statement::Loop { body, continuing, break_if } => {
                *body = self.block(body);
                *continuing = self.block(continuing);
                *break_if = break_if.map(|condition| self.of(condition));
            }
            Statement::Return { value } => *value = value.map(|value| self.of(value)),
            Statement::Store { pointer, value } => {
                (*pointer, *value) = (self.of(*pointer), self.of(*value));
            }
            Statement::ImageStore { image, coordinate, array_index, value } => {
                (*image, *coordinate) = (self.of(*image), self.of(*coordinate));
                *array_index = array_index.map(|index| self.of(index));
                *value = self.of(*value);
            }
            Statement::Atomic { pointer, fun, value, result } => {
                if let naga::AtomicFunction::Exchange { compare: Some(compare) } = fun {
                    *compare = self.of(*compare);
                }
                (*pointer, *value) = (self.of(*pointer), self.of(*value));
                *result = result.map(|result| self.of(result));
            }
            Statement::Call { arguments, result, .. } => {
                arguments.iter_mut().for_each(|argument| *argument = self.of(*argument));
                *result = result.map(|result| self.of(result));
            }
            Statement::Break
            | Statement::Continue
            | Statement::Kill
            | Statement::ControlBarrier(_)
            | Statement::MemoryBarrier(_) => {}
            other => panic!("no kernel has {other:?}"),
        }
        Some(new)
    }

    fn end_emit(&mut self, block: &mut Block) {
        if let Some((first, last)) = self.pending.take() {
            block.push(Statement::Emit(Range::new_from_bounds(first, last)), Span::UNDEFINED);
        }
    }

    fn emit(&mut self, expression: Expression) -> Handle<Expression> {
        let handle = self.new.append(expression, Span::UNDEFINED);
        self.pending = Some((self.pending.map_or(handle, |(first, _)| first), handle));
        handle
    }

    fn call(&mut self, name: &str, arguments: Vec<Handle<Expression>>, block: &mut Block) -> Handle<Expression> {
        let function = *self.context.operations.get(name).unwrap_or_else(|| panic!("no {name}"));
        self.end_emit(block);
        let result = self.new.append(Expression::CallResult(function), Span::UNDEFINED);
        let call = Statement::Call { function, arguments, result: Some(result) };
        block.push(call, Span::UNDEFINED);
        result
    }

    /// The number of components of an old expression, if they are f32. Otherwise `None`.
    fn size(&self, old: Handle<Expression>) -> Option<usize> {
        match *self.info[old].ty.inner_with(self.context.types) {
            TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => Some(1),
            TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => Some(size as usize),
            TypeInner::Matrix { .. } => panic!("no kernel has matrices"),
            _ => None,
        }
    }

    /// The new expression of an operand as a vector of the given size.
    fn operand(&mut self, old: Handle<Expression>, size: usize) -> Handle<Expression> {
        let value = self.of(old);
        let size = match size {
            2 => VectorSize::Bi,
            3 => VectorSize::Tri,
            4 => VectorSize::Quad,
            _ => return value,
        };
        if self.size(old) == Some(1) { self.emit(Expression::Splat { size, value }) } else { value }
    }

    fn expression(&mut self, old: Handle<Expression>, block: &mut Block) {
        let expression = &self.old.expressions[old];
        let is_rewritten = self.random.f64() < self.context.share;
        let new = match (self.size(old).filter(|_| is_rewritten), expression) {
            (Some(size), Expression::Binary { op, left, right }) => self.binary(*op, [*left, *right], size, block),
            (Some(_), Expression::Math { fun, arg, arg1, arg2, .. }) => {
                self.math(*fun, [Some(*arg), *arg1, *arg2], block)
            }
            _ => None,
        };
        let new = match new {
            Some(new) => new,
            None => {
                let mapped = self.mapped(expression);
                self.emit(mapped)
            }
        };
        self.map[old.index()] = Some(new);
    }

    fn binary(
        &mut self,
        op: BinaryOperator,
        [left, right]: [Handle<Expression>; 2],
        size: usize,
        block: &mut Block,
    ) -> Option<Handle<Expression>> {
        let name = match op {
            BinaryOperator::Add => "add",
            BinaryOperator::Subtract => "sub",
            BinaryOperator::Multiply => "mul",
            BinaryOperator::Divide if self.random.bool() => "div_inverse",
            BinaryOperator::Divide => "div",
            _ => return None,
        };
        if let Some(fused) = self.fused(op, [left, right], size, block) {
            return Some(fused);
        }
        let arguments = vec![self.operand(left, size), self.operand(right, size)];
        Some(self.call(&sized(name, size), arguments, block))
    }

    /// A sum or difference with a product as a term, which may be fused with it.
    fn fused(
        &mut self,
        op: BinaryOperator,
        [left, right]: [Handle<Expression>; 2],
        size: usize,
        block: &mut Block,
    ) -> Option<Handle<Expression>> {
        let is_difference = op == BinaryOperator::Subtract;
        if !(is_difference || op == BinaryOperator::Add) || self.random.u32(0..3) > 0 {
            return None;
        }
        let factors = |term: Handle<Expression>| match &self.old.expressions[term] {
            Expression::Binary { op: BinaryOperator::Multiply, left, right } => Some([*left, *right]),
            _ => None,
        };
        let negated =
            |rewriter: &mut Self, expr| rewriter.emit(Expression::Unary { op: naga::UnaryOperator::Negate, expr });
        let (factors, other, is_right) = match (factors(left), factors(right)) {
            (_, Some(factors)) => (factors, left, true),
            (Some(factors), _) => (factors, right, false),
            _ => return None,
        };
        let [mut first, second] = factors.map(|factor| self.operand(factor, size));
        let mut other = self.operand(other, size);
        if is_difference {
            let negative = if is_right { &mut first } else { &mut other };
            *negative = negated(self, *negative);
        }
        Some(self.call(&sized("fma", size), vec![first, second, other], block))
    }

    fn math(
        &mut self,
        fun: MathFunction,
        arguments: [Option<Handle<Expression>>; 3],
        block: &mut Block,
    ) -> Option<Handle<Expression>> {
        let size = self.size(arguments[0]?)?;
        let how = if self.random.bool() { "fused" } else { "apart" };
        let orders = ORDERS[size];
        let order = if orders.is_empty() { "" } else { orders[self.random.usize(0..orders.len())] };
        let name = match fun {
            MathFunction::Dot => format!("dot_{order}_{how}"),
            MathFunction::Length if size > 1 => format!("length_{order}_{how}"),
            MathFunction::Normalize => format!("normalize_{order}_{how}"),
            MathFunction::Cross => "cross".to_owned(),
            MathFunction::Mix => sized(if self.random.bool() { "mix_both" } else { "mix_difference" }, size),
            MathFunction::Sqrt => sized("sqrt", size),
            MathFunction::Exp => sized("exp", size),
            MathFunction::Pow => sized("pow", size),
            MathFunction::Fma => sized("fma", size),
            // Their results are exact.
            MathFunction::Abs
            | MathFunction::Min
            | MathFunction::Max
            | MathFunction::Clamp
            | MathFunction::Saturate
            | MathFunction::Floor
            | MathFunction::Ceil
            | MathFunction::Round
            | MathFunction::Trunc
            | MathFunction::Sign => return None,
            other => panic!("no kernel has {other:?}"),
        };
        let arguments: Vec<_> = arguments.into_iter().flatten().map(|argument| self.operand(argument, size)).collect();
        Some(self.call(&name, arguments, block))
    }

    /// The same expression with the new operands.
    fn mapped(&self, old: &Expression) -> Expression {
        let mut new = old.clone();
        let map = |handle: &mut Handle<Expression>| *handle = self.of(*handle);
        let map_any = |handle: &mut Option<Handle<Expression>>| {
            *handle = handle.map(|handle| self.of(handle));
        };
        match &mut new {
            Expression::Literal(_)
            | Expression::Constant(_)
            | Expression::Override(_)
            | Expression::ZeroValue(_)
            | Expression::FunctionArgument(_)
            | Expression::GlobalVariable(_)
            | Expression::LocalVariable(_)
            | Expression::CallResult(_)
            | Expression::AtomicResult { .. } => {}
            Expression::Compose { components, .. } => components.iter_mut().for_each(map),
            Expression::Access { base, index } => [base, index].into_iter().for_each(map),
            Expression::AccessIndex { base: value, .. }
            | Expression::Splat { value, .. }
            | Expression::Swizzle { vector: value, .. }
            | Expression::Load { pointer: value }
            | Expression::Unary { expr: value, .. }
            | Expression::Relational { argument: value, .. }
            | Expression::As { expr: value, .. }
            | Expression::ArrayLength(value) => map(value),
            Expression::Binary { left, right, .. } => [left, right].into_iter().for_each(map),
            Expression::Select { condition, accept, reject } => {
                [condition, accept, reject].into_iter().for_each(map);
            }
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                map(arg);
                [arg1, arg2, arg3].into_iter().for_each(map_any);
            }
            Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
                [image, coordinate].into_iter().for_each(map);
                [array_index, sample, level].into_iter().for_each(map_any);
            }
            Expression::ImageQuery { image, query } => {
                map(image);
                if let naga::ImageQuery::Size { level } = query {
                    map_any(level);
                }
            }
            other => panic!("no kernel has {other:?}"),
        }
        new
    }
}

/// The name of an operation on a number or a vector.
fn sized(name: &str, size: usize) -> String {
    if size == 1 { name.to_owned() } else { format!("{name}_{size}v") }
}
