//! A device that conforms to WGSL and yet rounds as it likes. Kernels are rewritten so that every operation with numbers
//! takes some result that the accuracy table of WGSL allows, chosen by a hash of its operands: equal operands have equal
//! results, as on every device. Products and sums are fused or not, terms of dot products are added in several orders,
//! and subnormal results may become zero. The functions of `shaders/math/fence.wgsl` stay what they are.

mod function;
mod vectors;

use std::collections::HashMap;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use pinhole::internals::KernelRewrite;

use function::{Context, Rewriter};

/// Which of the legal results of an operation is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rounding {
    Random,
    Up,
    Down,
    AwayFromZero,
    TowardZero,
    /// Each invocation takes them in one of these ways, half of them at random.
    EachItsOwn,
}

impl Rounding {
    pub(crate) const ALL: [Self; 6] = [
        Self::Random,
        Self::Up,
        Self::Down,
        Self::AwayFromZero,
        Self::TowardZero,
        Self::EachItsOwn,
    ];
}

/// A device that takes other legal results than the nearest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Adversary {
    pub(crate) rounding: Rounding,
    pub(crate) seed: u32,
    /// The share of operations that round so, by their places in kernels; compilers take long for many of them.
    pub(crate) share: f64,
    /// Whether equal operands have equal results in all kernels, and not only in each.
    pub(crate) is_alike: bool,
    /// By how many ULP all results are off instead, if not by 0: that is not legal.
    pub(crate) fault: u32,
}

impl Adversary {
    pub(crate) const fn new(rounding: Rounding, seed: u32) -> Self {
        Self { rounding, seed, share: 1.0, is_alike: false, fault: 0 }
    }

    /// What makes a device with this arithmetic.
    pub(crate) fn rewrite(self) -> KernelRewrite {
        KernelRewrite::new(move |name, source| self.rewritten(name, source))
    }

    /// The kernel with its operations replaced. One without fences is not changed: the checker does not follow it.
    fn rewritten(self, name: &str, source: &str) -> String {
        if !source.contains("fn fence(") {
            return source.to_owned();
        }
        let seed = seed_of(if self.is_alike { "" } else { name }, self.seed.into());
        let source = self.operations(seed as u32) + &begun(source);
        rewrite(&source, seed, self.share).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The text of the operations. Those of another seed have other results of the same operands.
    pub(crate) fn operations(self, seed: u32) -> String {
        let Self { rounding, fault, .. } = self;
        let mode = Rounding::ALL.iter().position(|other| *other == rounding).unwrap();
        let constants: String = [
            ("MODE", mode as u32),
            ("SEED", seed),
            ("DIVIDE_STEPS", 2),
            ("ROOT_STEPS", 4),
            ("FAULT", fault),
        ]
        .map(|(name, value)| format!("const {name}: u32 = {value}u;\n"))
        .concat();
        let operations = [include_str!("arithmetic.wgsl"), include_str!("steps.wgsl")].concat();
        constants + &operations + &vectors::source()
    }
}

/// The module with calls in place of its operations.
fn rewrite(source: &str, seed: u64, share: f64) -> Result<String, String> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let mut module =
        naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let info = validator.validate(&module).map_err(|error| error.emit_to_string(source))?;
    let name_of = |function: &naga::Function| function.name.clone().unwrap_or_default();
    let operations: HashMap<_, _> = module
        .functions
        .iter()
        .filter_map(|(handle, function)| {
            Some((name_of(function).strip_prefix("adv_")?.to_owned(), handle))
        })
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
    let text =
        naga::back::wgsl::write_string(&module, &info, flags).map_err(|error| error.to_string())?;
    Ok(text)
}

/// A number that depends on a name and another number.
fn seed_of(name: &str, seed: u64) -> u64 {
    name.bytes().fold(seed, |seed, byte| (seed ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The kernel whose invocations choose how they round before all else.
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
