//! Formats of other programs that are not read, with what to type to get one that is.

use std::path::Path;

use crate::load::error::LoadError;
use crate::load::format::Format;

/// Extensions, and what to do with such a file. `FILE` stands for its name, and `STEM` for the name without extension.
const REFUSED: [(&[&str], &str); 8] = [
    (&["traj", "xsf", "cube", "cfg", "res", "xsd"], "convert it: ase convert FILE STEM.extxyz"),
    (&["bcif", "mmtf"], "take the .cif.gz of the same entry"),
    (&["h5", "hdf5"], "save its positions in Python: np.savez(\"STEM.npz\", positions=f[\"...\"][:])"),
    (&["nc", "ncdf"], "convert it: mdconvert FILE -o STEM.dcd"),
    (&["tpr"], "convert it: gmx editconf -f FILE -o STEM.gro"),
    (&["psf", "prmtop", "top"], "give --topology a PDB or GRO file of the same atoms"),
    (&["mae", "maegz"], "convert it: obabel FILE -O STEM.mol2"),
    (&["pcd", "e57", "laz"], "save it as PLY"),
];

impl Format {
    /// The error for a file whose format is known, but not read; `None` for others.
    #[must_use]
    pub fn refused(path: &Path) -> Option<LoadError> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        let (_, remedy) = REFUSED.iter().find(|(extensions, _)| extensions.contains(&&*extension))?;
        let name = |name: Option<&std::ffi::OsStr>| name.unwrap_or_default().to_string_lossy().into_owned();
        let (file, stem) = (name(path.file_name()), name(path.file_stem()));
        // The name may contain the word STEM.
        let parts: Vec<String> = remedy.split("STEM").map(|part| part.replace("FILE", &file)).collect();
        Some(LoadError::new(format!(".{extension} is not read; {}", parts.join(&stem))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_that_is_not_read_has_a_remedy() {
        for (name, words) in [
            ("a/run 1.TRAJ", ".traj is not read; convert it: ase convert run 1.TRAJ run 1.extxyz"),
            ("a.h5", ".h5 is not read; save its positions in Python: np.savez(\"a.npz\", positions=f[\"...\"][:])"),
            ("STEM.tpr", ".tpr is not read; convert it: gmx editconf -f STEM.tpr -o STEM.gro"),
        ] {
            assert_eq!(Format::refused(Path::new(name)).unwrap().to_string(), words);
        }
        assert_eq!(Format::refused(Path::new("a.doc")), None);
        for extension in REFUSED.iter().flat_map(|(extensions, _)| *extensions) {
            assert_eq!(Format::of_extension(extension), None, "{extension} is read");
        }
    }
}
