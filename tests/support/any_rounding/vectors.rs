//! The text of the operations of vectors, which are made of those of numbers.

/// The components of a vector.
const AXES: [&str; 4] = ["x", "y", "z", "w"];

/// The orders in which the terms of a dot product are added, by the number of components.
pub(super) const ORDERS: [&[&str]; 5] =
    [&[], &[], &["xy", "yx"], &["xyz", "yzx", "zxy"], &["xyzw", "wzyx"]];

/// The name of a type of vector or number with f32 components.
fn vector(size: usize) -> String {
    if size == 1 { "f32".to_owned() } else { format!("vec{size}f") }
}

/// A function of numbers, applied to each component.
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

/// A dot product whose terms are added in an order, fused or not.
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

/// All operations of vectors, and those of numbers that are made of several.
pub(super) fn source() -> String {
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
