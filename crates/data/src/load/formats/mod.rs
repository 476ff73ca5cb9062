//! The table of file formats, one row for each. Formats are looked up by name, extension or content, and each row says
//! which options apply to the format.

use std::ffi::OsStr;
use std::io;
use std::path::Path;

use crate::load::compressed::without_ending;
use crate::load::cone_kind::ConeKind;
use crate::load::dataset::Dataset;
use crate::load::error::LoadError;
use crate::load::file_set::FileSet;
use crate::load::format::{Format, Options, ReadMethod};
use crate::load::source::Source;
use crate::load::table::Columns;

pub mod csv;
mod dcd;
mod gromacs;
mod gsd;
pub mod lammps;
mod las;
pub mod mmcif;
mod mol2;
pub mod npy;
pub mod npz;
pub mod pdb;
mod ply;
pub mod raw;
mod sdf;
mod vasp;
mod vtk;
pub mod xyz;

/// A format without a name, a header and extras. The rows of the table override what they have.
const RAW: Format = Format {
    name: "raw-f32x4",
    extensions: &[],
    file_names: &[],
    about: "Raw numbers without a header: x, y, z, radius in little-endian f32",
    method: ReadMethod::Whole(|bytes, _| Ok(Dataset::new(raw::read_spheres(bytes)?))),
    needs_topology: false,
    may_lack_names: false,
    may_lack_radii: false,
    has_colors: false,
    z_is_up: false,
    is_text: false,
    starts: |_| false,
    extra_bytes: |_| Ok(0),
    rows: |_, _, _| None,
};

/// The facts about text formats.
const TEXT: Format = Format { is_text: true, ..RAW };

/// All formats that this build can read. No two of them share a name or an extension.
pub static FORMATS: &[Format] = &[
    Format {
        name: "xyz",
        extensions: &["xyz"],
        about: "Text with one atom on each line (XYZ)",
        method: ReadMethod::Frames(xyz::FRAMES),
        may_lack_radii: true,
        has_colors: true,
        starts: xyz::starts,
        ..TEXT
    },
    Format {
        name: "extxyz",
        extensions: &["extxyz"],
        about: "Text with one atom on each line and named columns (extended XYZ)",
        method: ReadMethod::Frames(xyz::FRAMES),
        may_lack_radii: true,
        has_colors: true,
        ..TEXT
    },
    Format {
        name: "pdb",
        extensions: &["pdb", "ent"],
        about: "Text in the fixed columns of the Protein Data Bank; a frame is a model",
        method: ReadMethod::Frames(pdb::FRAMES),
        has_colors: true,
        starts: pdb::starts,
        ..TEXT
    },
    Format {
        name: "pdbqt",
        extensions: &["pdbqt"],
        about: "PDB with the partial charges and types of AutoDock; a frame is a model",
        method: ReadMethod::Frames(pdb::DOCKING),
        has_colors: true,
        ..TEXT
    },
    Format {
        name: "gro",
        extensions: &["gro"],
        about: "Text in the fixed columns of GROMACS, with a box and perhaps velocities",
        method: ReadMethod::Frames(gromacs::GRO),
        has_colors: true,
        starts: gromacs::starts_gro,
        ..TEXT
    },
    Format {
        name: "lammps-dump",
        extensions: &["lammpstrj", "dump"],
        about: "A dump of atoms of LAMMPS; a frame is a step",
        method: ReadMethod::Frames(lammps::dump::FRAMES),
        may_lack_names: true,
        may_lack_radii: true,
        z_is_up: true,
        starts: lammps::dump::starts,
        ..TEXT
    },
    Format {
        name: "lammps-data",
        extensions: &["data", "lmp"],
        about: "A data file of LAMMPS, with the section Atoms",
        method: ReadMethod::Whole(lammps::data::read),
        may_lack_names: true,
        may_lack_radii: true,
        z_is_up: true,
        starts: lammps::data::starts,
        ..TEXT
    },
    Format {
        name: "poscar",
        extensions: &["vasp", "poscar"],
        file_names: &["POSCAR", "CONTCAR", "XDATCAR"],
        about: "Structures of VASP (POSCAR, CONTCAR); a frame is a configuration of XDATCAR",
        method: ReadMethod::Frames(vasp::FRAMES),
        may_lack_radii: true,
        has_colors: true,
        starts: vasp::starts,
        ..TEXT
    },
    Format {
        name: "sdf",
        extensions: &["sdf", "mol"],
        about: "Molecules in the formats of MDL, V2000 and V3000; a frame is a molecule",
        method: ReadMethod::Frames(sdf::FRAMES),
        may_lack_radii: true,
        has_colors: true,
        starts: sdf::starts,
        ..TEXT
    },
    Format {
        name: "mol2",
        extensions: &["mol2"],
        about: "Molecules of Tripos, with residues and a cell; a frame is a molecule",
        method: ReadMethod::Frames(mol2::FRAMES),
        may_lack_radii: true,
        has_colors: true,
        starts: mol2::starts,
        ..TEXT
    },
    Format {
        name: "mmcif",
        extensions: &["cif", "mmcif"],
        about: "Text of named items (mmCIF), or the CIF of a small molecule; a frame is a model",
        method: ReadMethod::Frames(mmcif::FRAMES),
        has_colors: true,
        starts: mmcif::starts,
        ..TEXT
    },
    Format {
        name: "las",
        extensions: &["las"],
        about: "Points of a laser scanner (LAS)",
        method: ReadMethod::Whole(las::read),
        may_lack_radii: true,
        z_is_up: true,
        starts: las::starts,
        ..RAW
    },
    Format {
        name: "gsd",
        extensions: &["gsd"],
        about: "Particles of HOOMD-blue (GSD)",
        method: ReadMethod::Frames(gsd::FRAMES),
        may_lack_radii: true,
        z_is_up: true,
        starts: gsd::starts,
        ..RAW
    },
    Format {
        name: "dcd",
        extensions: &["dcd"],
        about: "Positions of atoms by CHARMM, NAMD, OpenMM or LAMMPS, with a topology",
        method: ReadMethod::Frames(dcd::FRAMES),
        needs_topology: true,
        starts: dcd::starts,
        ..RAW
    },
    Format {
        name: "trr",
        extensions: &["trr"],
        about: "Positions and velocities of atoms by GROMACS, with a topology",
        method: ReadMethod::Frames(gromacs::TRR),
        needs_topology: true,
        starts: gromacs::starts_trr,
        ..RAW
    },
    Format {
        name: "xtc",
        extensions: &["xtc"],
        about: "Compressed positions of atoms by GROMACS, with a topology",
        method: ReadMethod::Frames(gromacs::XTC),
        needs_topology: true,
        starts: gromacs::starts_xtc,
        ..RAW
    },
    Format {
        name: "npy",
        extensions: &["npy"],
        about: "A NumPy array of x, y, z, and radius, a value or colors, or of structures",
        method: ReadMethod::Whole(|bytes, options| npy::read(bytes, options.radius)),
        may_lack_radii: true,
        starts: |bytes| bytes.starts_with(b"\x93NUMPY"),
        extra_bytes: |bytes| Ok(npy::extra_bytes(bytes)),
        rows: npy::rows_of,
        ..RAW
    },
    Format {
        name: "npz",
        extensions: &["npz"],
        about: "A NumPy archive with arrays of positions, radii, colors and so on",
        method: ReadMethod::Whole(|bytes, options| npz::read(bytes, options.radius)),
        may_lack_radii: true,
        starts: |bytes| bytes.starts_with(b"PK\x03\x04"),
        extra_bytes: |bytes| npz::array_bytes(bytes),
        ..RAW
    },
    Format {
        name: "csv",
        extensions: &["csv", "tsv"],
        about: "A table of text with commas, tabs, semicolons or white space",
        method: ReadMethod::Whole(csv::read),
        may_lack_names: true,
        may_lack_radii: true,
        starts: csv::starts,
        ..TEXT
    },
    Format {
        name: "ply",
        extensions: &["ply"],
        about: "The vertices of a PLY file, as text or binary data",
        method: ReadMethod::Whole(ply::read),
        may_lack_radii: true,
        starts: ply::starts,
        ..RAW
    },
    Format {
        name: "vtk",
        extensions: &["vtp", "vtu"],
        about: "The points of a VTK XML file: PolyData or UnstructuredGrid",
        method: ReadMethod::Whole(vtk::read),
        may_lack_radii: true,
        starts: vtk::starts,
        ..RAW
    },
    Format { rows: |_, size, _| raw::rows_of(size), ..RAW },
];

/// Reads the columns of a file of cylinders or cones.
type ReadColumns = fn(&[u8], ConeKind) -> Result<Columns, LoadError>;

/// The formats of files of cylinders and cones, by their names.
pub(super) const CONE_FORMATS: [(&str, ReadColumns); 3] =
    [("npy", npy::columns), ("npz", |bytes, _| npz::columns(bytes)), ("csv", csv::columns)];

impl Format {
    /// Returns the format with this name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<&'static Self> {
        FORMATS.iter().find(|format| format.name == name)
    }

    /// Returns the format with this extension, which may be in upper or lower case.
    pub(crate) fn of_extension(extension: &str) -> Option<&'static Self> {
        let extension = extension.to_ascii_lowercase();
        FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
    }

    /// Returns the format that the first bytes of a file look like; a few hundred bytes are enough.
    #[must_use]
    pub fn of_content(bytes: &[u8]) -> Option<&'static Self> {
        FORMATS.iter().find(|format| (format.starts)(bytes))
    }

    /// Returns the format of a file by its extension, or else by the first bytes of a regular file, which may be
    /// compressed. Other files are not opened, because a pipe can be read only once. Where a name stands for several
    /// files, it is the format of the first.
    ///
    /// # Errors
    /// Returns an error if the first bytes are needed and cannot be read.
    pub fn of_path(path: &Path) -> io::Result<Option<&'static Self>> {
        let format = Self::of_file_name(path);
        if format.is_some() {
            return Ok(format);
        }
        if let Ok(Some(set)) = FileSet::of(path)
            && let Some(first) = set.files().first()
        {
            return Self::of_path(first);
        }
        if !path.is_file() {
            return Ok(None);
        }
        Ok(Self::of_content(&Source::open(path)?.start()?))
    }

    /// Returns the format with the extension of a file's name, without `.gz` and the like, or else with the start of the name.
    fn of_file_name(path: &Path) -> Option<&'static Self> {
        let path = without_ending(path);
        let by_extension = path.extension().and_then(OsStr::to_str).and_then(Self::of_extension);
        by_extension.or_else(|| {
            let name = path.file_name()?.to_str()?;
            FORMATS.iter().find(|format| format.file_names.iter().any(|start| name.starts_with(start)))
        })
    }

    /// Returns the format of a file by its extension or else by its first bytes.
    pub(super) fn of_file(path: &Path, first: &[u8]) -> Result<&'static Self, LoadError> {
        let format = Self::of_file_name(path).or_else(|| Self::of_content(first));
        format.ok_or_else(|| Self::refused(path).unwrap_or_else(Self::unknown))
    }

    /// The error of a file whose format neither the name nor the content shows.
    #[must_use]
    pub fn unknown() -> LoadError {
        let names: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
        LoadError::new(format!(
            "neither the name nor the content of this file shows its format; choose one of {}",
            names.join(", ")
        ))
    }

    /// Lists the extensions and names of files of all formats for which `is_wanted` returns true, such as `.npy, .npz,
    /// POSCAR*`.
    #[must_use]
    pub fn extensions_of(is_wanted: impl Fn(&Self) -> bool) -> String {
        let wanted = FORMATS.iter().filter(|format| is_wanted(format));
        let names = wanted.flat_map(|format| {
            let extensions = format.extensions.iter().map(|extension| format!(".{extension}"));
            extensions.chain(format.file_names.iter().map(|start| format!("{start}*")))
        });
        names.collect::<Vec<_>>().join(", ")
    }

    /// Checks that every given option applies to this format.
    ///
    /// # Errors
    /// Returns the first option that does not apply.
    pub fn check(&self, options: &Options) -> Result<(), LoadError> {
        let refused = |option, what: String| Err(LoadError::new(format!("{option} applies only to {what}; remove it")));
        if options.frame.is_some() && !self.has_frames() {
            let what = format!("trajectories ({})", Self::extensions_of(|format| format.has_frames()));
            return refused("frame", what);
        }
        if options.radius.is_some() && !self.may_lack_radii {
            let files = Self::extensions_of(|format| format.may_lack_radii);
            let what = format!("data that can lack radii ({files})");
            return refused("radius", what);
        }
        if options.topology.is_some() && !self.needs_topology {
            let what =
                format!("trajectories of positions alone ({})", Self::extensions_of(|format| format.needs_topology));
            return refused("topology", what);
        }
        if !options.columns.is_empty() && !self.may_lack_names {
            let files = Self::extensions_of(|format| format.may_lack_names);
            return refused("columns", format!("tables ({files})"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_and_extension_belongs_to_one_format() {
        let mut seen = std::collections::HashSet::new();
        for format in FORMATS {
            assert_eq!(Format::of_name(format.name), Some(format));
            for extension in format.extensions {
                assert!(seen.insert(extension), "{extension} belongs to several formats");
                assert_eq!(Format::of_extension(&extension.to_uppercase()), Some(format));
            }
        }
    }

    #[test]
    fn names_of_files_show_the_format() {
        for (name, format) in [
            ("POSCAR", Some("poscar")),
            ("a/XDATCAR_300K.xz", Some("poscar")),
            ("CONTCAR.2", Some("poscar")),
            ("POSCAR.xyz", Some("xyz")),
            ("a.VASP", Some("poscar")),
            ("poscar", None),
            ("POSCAR/a.out", None),
        ] {
            assert_eq!(Format::of_file_name(Path::new(name)).map(|format| format.name), format, "{name}");
        }
    }

    #[test]
    fn options_that_do_not_apply_are_refused() {
        let raw = Format::of_name("raw-f32x4").unwrap();
        let refused = raw.read(&[], &Options::default().with_frame(1)).unwrap_err().to_string();
        assert!(refused.starts_with("frame applies only to trajectories ("), "{refused}");
        assert!(raw.read(&[], &Options::default().with_radius(1.0)).is_err());
        assert!(raw.read(&[], &Options::default()).unwrap().spheres.is_empty());
    }

    #[test]
    fn content_shows_the_format() {
        for (bytes, name) in [
            (&b"\x93NUMPY\x01"[..], "npy"),
            (b"PK\x03\x04", "npz"),
            (b"ply\r\nformat ascii 1.0", "ply"),
            (b"12\n\nH 0 0 0", "xyz"),
            (b"HEADER    OXYGEN TRANSPORT", "pdb"),
            (b"Water t= 0\n 1\n    1SOL     OW    1   0.126   1.624   1.679\n", "gro"),
            (b"salt\n5.64\n1 0 0\n0 1 0\n0 0 1\nNa Cl\n4 4\nDirect\n", "poscar"),
            (b"water\n\n\n  3  2  0  0  0  0            999 V2000\n", "sdf"),
            (b"# made\n\n@<TRIPOS>MOLECULE\nwater\n", "mol2"),
            (b"ITEM: TIMESTEP\n0\n", "lammps-dump"),
            (b"id,X,y,z,q\n1,2", "csv"),
            (b"made by me\n\n 20 atoms\n", "lammps-data"),
            (b"# comment\n\nData_4HHB\n", "mmcif"),
        ] {
            assert_eq!(Format::of_content(bytes).map(|format| format.name), Some(name));
        }
        assert_eq!(Format::of_content(b""), None);
    }
}
