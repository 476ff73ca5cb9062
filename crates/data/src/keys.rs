//! The words for values of atoms and other spheres, and the columns that may hold them. Programs name them differently.

/// A key: its name, its aliases, and the columns that can hold it, the first first.
#[derive(Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) aliases: &'static [&'static str],
    pub(crate) columns: &'static [&'static str],
}

const fn key(name: &'static str, aliases: &'static [&'static str], columns: &'static [&'static str]) -> Key {
    Key { name, aliases, columns }
}

pub(crate) const KEYS: &[Key] = &[
    key("element", &["elem", "species", "symbol", "e."], &["element", "species"]),
    key("name", &["atom", "atomname", "n."], &["name", "atom_name", "type", "species", "element"]),
    key("type", &["particletype", "atomtype"], &["type", "species", "element"]),
    key("resname", &["resn", "residue_name", "r."], &["resname", "residue_name", "resn", "residue"]),
    key(
        "resid",
        &["resi", "resseq", "resnum", "residue_number", "i."],
        &["resid", "residue_number", "resi", "resseq", "resnum"],
    ),
    key("icode", &["insertion_code"], &["icode"]),
    key("residue", &[], &[]),
    key("resindex", &[], &[]),
    key("chain", &["chainid", "c."], &["chain", "chain_id", "chainid"]),
    key("segid", &["segname", "segment", "segi", "s."], &["segid", "segname", "segi"]),
    key("index", &[], &["index"]),
    key("bynum", &[], &[]),
    key("serial", &["id", "particleidentifier"], &["serial", "id"]),
    key("altloc", &["alt"], &["altloc"]),
    key("b_factor", &["b", "bfactor", "beta"], &["b_factor", "bfactor", "beta"]),
    key("occupancy", &["q"], &["occupancy"]),
    key("charge", &["pc."], &["charge", "charges", "q"]),
    key("formal_charge", &["fc."], &["formal_charge"]),
    key("mass", &["masses"], &["mass", "masses"]),
    key("radius", &[], &["radius"]),
    key("record", &["record_type"], &["record"]),
    key("model", &[], &["model"]),
    key("file", &[], &["file"]),
    key("mol", &["molecule", "moleculeidentifier"], &["mol", "molecule"]),
    key("fragment", &["frag"], &[]),
    key("numbonds", &["coordination"], &["numbonds"]),
    key("x", &["position.x", "position_x"], &["x"]),
    key("y", &["position.y", "position_y"], &["y"]),
    key("z", &["position.z", "position_z"], &["z"]),
];

/// The key that a word names, in upper or lower case.
pub(crate) fn key_of(word: &str) -> Option<&'static Key> {
    let is = |name: &&str| name.eq_ignore_ascii_case(word);
    KEYS.iter().find(|key| is(&key.name) || key.aliases.iter().any(&is))
}
