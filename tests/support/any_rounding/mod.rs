//! A device that conforms to WGSL but rounds in unusual ways. Kernels are rewritten so that every operation with
//! numbers takes some result that the accuracy table of WGSL allows, chosen by a hash of its operands. Equal operands
//! have equal results, as on every device. Products and sums are fused or not, terms of dot products are added in
//! several orders, and subnormal results may become zero. The functions of `shaders/math/fence.wgsl` do not change.

mod function;

use std::collections::HashMap;

use function::{Context, Rewriter};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use pinhole::internals::KernelRewrite;

/// The choice among the legal results of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rounding {
    Random,
    Up,
    Down,
    AwayFromZero,
    TowardZero,
    /// Each invocation uses one of these ways, half of them random.
    EachItsOwn,
}

impl Rounding {
    pub(crate) const ALL: [Self; 6] =
        [Self::Random, Self::Up, Self::Down, Self::AwayFromZero, Self::TowardZero, Self::EachItsOwn];
}

/// A device that returns legal results other than the nearest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Adversary {
    pub(crate) rounding: Rounding,
    pub(crate) seed: u32,
    /// The fraction of operations that round like this, by their places in kernels. Many of them take long to compile.
    pub(crate) share: f64,
    /// Whether equal operands have equal results across kernels, and not only within each.
    pub(crate) is_alike: bool,
    /// The error of all results in ULP instead, if it is not 0. Such results are not legal.
    pub(crate) fault: u32,
}

impl Adversary {
    pub(crate) const fn new(rounding: Rounding, seed: u32) -> Self {
        Self { rounding, seed, share: 1.0, is_alike: false, fault: 0 }
    }

    /// The rewriting of kernels that gives a device this arithmetic.
    pub(crate) fn rewrite(self) -> KernelRewrite {
        KernelRewrite::new(move |name, source| self.rewritten(name, source))
    }

    /// The kernel with its operations replaced. Kernels without fences do not change, as the checker ignores them.
    fn rewritten(self, name: &str, source: &str) -> String {
        if !source.contains("fn fence(") {
            return source.to_owned();
        }
        let seed = seed_of(if self.is_alike { "" } else { name }, self.seed.into());
        let source = self.operations(seed as u32) + &begun(source);
        rewrite(&source, seed, self.share).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The text of the operations. With another seed, the same operands have other results.
    pub(crate) fn operations(self, seed: u32) -> String {
        let Self { rounding, fault, .. } = self;
        let mode = Rounding::ALL.iter().position(|other| *other == rounding).unwrap();
        let constants: String =
            [("MODE", mode as u32), ("SEED", seed), ("DIVIDE_STEPS", 2), ("ROOT_STEPS", 4), ("FAULT", fault)]
                .map(|(name, value)| format!("const {name}: u32 = {value}u;\n"))
                .concat();
        let operations = [include_str!("arithmetic.wgsl"), include_str!("steps.wgsl")].concat();
        constants + &operations + &vectors()
    }
}

/// Rewrites a module with calls in place of its operations.
fn rewrite(source: &str, seed: u64, share: f64) -> Result<String, String> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let mut module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let info = validator.validate(&module).map_err(|error| error.emit_to_string(source))?;
    let name_of = |function: &naga::Function| function.name.clone().unwrap_or_default();
    let operations: HashMap<_, _> = module
        .functions
        .iter()
        .filter_map(|(handle, function)| Some((name_of(function).strip_prefix("adv_")?.to_owned(), handle)))
        .collect();
    let types = module.types.clone();
    let context = Context { types: &types, operations: &operations, seed, share };
    let rewritten: Vec<_> = module
        .functions
        .iter()
        .filter(|(_, function)| !name_of(function).starts_with("adv_"))
        .map(|(handle, function)| (handle, Rewriter::rewrite(&context, function, &info[handle])))
        .collect();
    for (handle, function) in rewritten {
        module.functions[handle] = function;
    }
    for (index, entry) in module.entry_points.iter_mut().enumerate() {
        let info = info.get_entry_point(index);
        entry.function = Rewriter::rewrite(&context, &entry.function, info);
    }
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).map_err(|error| format!("{error:?}"))?;
    let flags = naga::back::wgsl::WriterFlags::empty();
    let text = naga::back::wgsl::write_string(&module, &info, flags).map_err(|error| error.to_string())?;
    Ok(text)
}

/// A seed computed from a name and a number.
fn seed_of(name: &str, seed: u64) -> u64 {
    name.bytes().fold(seed, |seed, byte| (seed ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The kernel, whose invocations first choose how they round.
fn begun(source: &str) -> String {
    let named = |builtin: &str| {
        let (_, rest) = source.split_once(builtin)?;
        rest.split_once(':').map(|(name, _)| name.trim().to_owned())
    };
    let lane = named("@builtin(local_invocation_index) ");
    let invocation = named("@builtin(global_invocation_id) ");
    let id = invocation.map(|id| format!("{id}.x + 331u * {id}.y")).or(lane);
    let begin = format!("start_fences();\n    adv_begin({});", id.as_deref().unwrap_or("0u"));
    source.replacen("    start_fences();", &format!("    {begin}"), 1)
}

/// The components of a vector.
const AXES: [&str; 4] = ["x", "y", "z", "w"];

/// The orders in which the terms of a dot product are added, by the number of components.
const ORDERS: [&[&str]; 5] = [&[], &[], &["xy", "yx"], &["xyz", "yzx", "zxy"], &["xyzw", "wzyx"]];

/// The name of an f32 type with `size` components.
fn vector(size: usize) -> String {
    if size == 1 { "f32".to_owned() } else { format!("vec{size}f") }
}

/// A function of numbers that is applied to each component.
fn componentwise(name: &str, arguments: &[&str], size: usize) -> String {
    let vector = vector(size);
    let list: Vec<_> = arguments.iter().map(|argument| format!("{argument}: {vector}")).collect();
    let of = |axis: &str| {
        let each: Vec<_> = arguments.iter().map(|argument| format!("{argument}.{axis}")).collect();
        format!("adv_{name}({})", each.join(", "))
    };
    let components: Vec<_> = AXES[..size].iter().map(|axis| of(axis)).collect();
    format!(
        "fn adv_{name}_{size}v({}) -> {vector} {{ return {vector}({}); }}\n",
        list.join(", "),
        components.join(", ")
    )
}

/// A dot product whose terms are added in the given order, fused or not.
fn dot(size: usize, order: &str, is_fused: bool) -> String {
    let product = |axis: char| format!("adv_mul(a.{axis}, b.{axis})");
    let mut axes = order.chars();
    let first = axes.next().map(product).unwrap_or_default();
    let sum = axes.fold(first, |sum, axis| match is_fused {
        true => format!("adv_fma(a.{axis}, b.{axis}, {sum})"),
        false => format!("adv_add({sum}, {})", product(axis)),
    });
    let (how, vector) = (if is_fused { "fused" } else { "apart" }, vector(size));
    format!("fn adv_dot_{order}_{how}(a: {vector}, b: {vector}) -> f32 {{ return {sum}; }}\n")
}

/// All operations on vectors, and the operations on numbers that combine several others.
fn vectors() -> String {
    let mut source = String::new();
    source += "fn adv_sub(a: f32, b: f32) -> f32 { return adv_add(a, -b); }\n";
    // The two formulas that WGSL gives for `mix`.
    source += "fn adv_mix_both(a: f32, b: f32, t: f32) -> f32 {
        return adv_add(adv_mul(a, adv_sub(1.0, t)), adv_mul(b, t));
    }\n";
    source += "fn adv_mix_difference(a: f32, b: f32, t: f32) -> f32 {
        return adv_add(a, adv_mul(adv_sub(b, a), t));
    }\n";
    for (size, orders) in ORDERS.iter().enumerate().skip(2) {
        for name in ["add", "sub", "mul", "div", "div_inverse", "pow"] {
            source += &componentwise(name, &["a", "b"], size);
        }
        for name in ["sqrt", "exp"] {
            source += &componentwise(name, &["a"], size);
        }
        for name in ["mix_both", "mix_difference"] {
            source += &componentwise(name, &["a", "b", "t"], size);
        }
        source += &componentwise("fma", &["a", "b", "c"], size);
        for order in *orders {
            source += &dot(size, order, false);
            source += &dot(size, order, true);
            for how in ["apart", "fused"] {
                let (name, vector) = (format!("{order}_{how}"), vector(size));
                source += &format!(
                    "fn adv_length_{name}(a: {vector}) -> f32 {{ return adv_sqrt(adv_dot_{name}(a, a)); }}
                    fn adv_normalize_{name}(a: {vector}) -> {vector} {{
                        return adv_div_{size}v(a, {vector}(adv_length_{name}(a)));
                    }}\n"
                );
            }
        }
    }
    source += "fn adv_cross(a: vec3f, b: vec3f) -> vec3f {
        return adv_sub_3v(adv_mul_3v(a.yzx, b.zxy), adv_mul_3v(a.zxy, b.yzx));
    }\n";
    source
}
