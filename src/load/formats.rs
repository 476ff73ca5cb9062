//! The table of file formats, one row for each.

use super::error::LoadError;
use super::format::Format;
use super::loaded::Loaded;
use super::raw;
#[allow(unused_imports, reason = "not every format has frames")]
use super::trajectory::read_from_memory;

/// All formats that this build can read. No two of them share a name or an extension.
pub static FORMATS: &[Format] = &[
    #[cfg(feature = "xyz")]
    Format {
        name: "xyz",
        extensions: &["xyz"],
        about: "Text with one atom on each line (XYZ)",
        frames: Some(super::xyz::FRAMES),
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: true,
        starts: super::xyz::starts,
        reader: |bytes, options| read_from_memory(bytes, super::xyz::FRAMES, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "xyz")]
    Format {
        name: "extxyz",
        extensions: &["extxyz"],
        about: "Text with one atom on each line and named columns (extended XYZ)",
        frames: Some(super::xyz::FRAMES),
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: true,
        starts: never,
        reader: |bytes, options| read_from_memory(bytes, super::xyz::FRAMES, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "pdb")]
    Format {
        name: "pdb",
        extensions: &["pdb", "ent"],
        about: "Text in the fixed columns of the Protein Data Bank; a frame is a model",
        frames: Some(super::pdb::FRAMES),
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: false,
        has_colors: true,
        starts: super::pdb::starts,
        reader: |bytes, options| read_from_memory(bytes, super::pdb::FRAMES, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "lammps")]
    Format {
        name: "lammps-dump",
        extensions: &["lammpstrj", "dump"],
        about: "A dump of atoms of LAMMPS; a frame is a step",
        frames: Some(super::lammps::dump::FRAMES),
        needs_topology: false,
        may_lack_names: true,
        may_lack_radii: true,
        has_colors: false,
        starts: super::lammps::dump::starts,
        reader: |bytes, options| read_from_memory(bytes, super::lammps::dump::FRAMES, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "lammps")]
    Format {
        name: "lammps-data",
        extensions: &["data", "lmp"],
        about: "A data file of LAMMPS, with the section Atoms",
        frames: None,
        needs_topology: false,
        may_lack_names: true,
        may_lack_radii: true,
        has_colors: false,
        starts: super::lammps::data::starts,
        reader: super::lammps::data::read,
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "mmcif")]
    Format {
        name: "mmcif",
        extensions: &["cif", "mmcif"],
        about: "Text of named items (mmCIF), or the CIF of a small molecule; a frame is a model",
        frames: Some(super::mmcif::FRAMES),
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: false,
        has_colors: true,
        starts: super::mmcif::starts,
        reader: |bytes, options| read_from_memory(bytes, super::mmcif::FRAMES, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "las")]
    Format {
        name: "las",
        extensions: &["las"],
        about: "Points of a laser scanner (LAS)",
        frames: None,
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: false,
        starts: super::las::starts,
        reader: super::las::read,
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "gsd")]
    Format {
        name: "gsd",
        extensions: &["gsd"],
        about: "Particles of HOOMD-blue (GSD)",
        frames: Some(super::gsd::FRAMES),
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: false,
        starts: super::gsd::starts,
        reader: |bytes, options| read_from_memory(bytes, super::gsd::FRAMES, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "dcd")]
    Format {
        name: "dcd",
        extensions: &["dcd"],
        about: "Positions of atoms by CHARMM, NAMD, OpenMM or LAMMPS, with a topology",
        frames: Some(super::dcd::FRAMES),
        needs_topology: true,
        may_lack_names: false,
        may_lack_radii: false,
        has_colors: false,
        starts: super::dcd::starts,
        reader: |bytes, options| read_from_memory(bytes, super::dcd::FRAMES, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "gromacs")]
    Format {
        name: "trr",
        extensions: &["trr"],
        about: "Positions and velocities of atoms by GROMACS, with a topology",
        frames: Some(super::gromacs::TRR),
        needs_topology: true,
        may_lack_names: false,
        may_lack_radii: false,
        has_colors: false,
        starts: super::gromacs::starts_trr,
        reader: |bytes, options| read_from_memory(bytes, super::gromacs::TRR, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "gromacs")]
    Format {
        name: "xtc",
        extensions: &["xtc"],
        about: "Compressed positions of atoms by GROMACS, with a topology",
        frames: Some(super::gromacs::XTC),
        needs_topology: true,
        may_lack_names: false,
        may_lack_radii: false,
        has_colors: false,
        starts: super::gromacs::starts_xtc,
        reader: |bytes, options| read_from_memory(bytes, super::gromacs::XTC, options),
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "npy")]
    Format {
        name: "npy",
        extensions: &["npy"],
        about: "A NumPy array of x, y, z, and radius, a value or colors, or of structures",
        frames: None,
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: false,
        starts: |bytes| bytes.starts_with(b"\x93NUMPY"),
        reader: |bytes, options| Ok(super::npy::read(bytes, options.radius)?),
        extra_bytes: |bytes| Ok(super::npy::extra_bytes(bytes)),
    },
    #[cfg(feature = "npy")]
    Format {
        name: "npz",
        extensions: &["npz"],
        about: "A NumPy archive with arrays of positions, radii, colors and so on",
        frames: None,
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: false,
        starts: |bytes| bytes.starts_with(b"PK\x03\x04"),
        reader: |bytes, options| Ok(super::npz::read(bytes, options.radius)?),
        extra_bytes: |bytes| Ok(super::npz::array_bytes(bytes)?),
    },
    #[cfg(feature = "csv")]
    Format {
        name: "csv",
        extensions: &["csv", "tsv"],
        about: "A table of text with commas, tabs, semicolons or white space",
        frames: None,
        needs_topology: false,
        may_lack_names: true,
        may_lack_radii: true,
        has_colors: false,
        starts: super::csv::starts,
        reader: super::csv::read,
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "ply")]
    Format {
        name: "ply",
        extensions: &["ply"],
        about: "The vertices of a PLY file, as text or binary data",
        frames: None,
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: false,
        starts: super::ply::starts,
        reader: super::ply::read,
        extra_bytes: no_extra_bytes,
    },
    #[cfg(feature = "vtk")]
    Format {
        name: "vtk",
        extensions: &["vtp", "vtu"],
        about: "The points of a VTK XML file: PolyData or UnstructuredGrid",
        frames: None,
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: true,
        has_colors: false,
        starts: super::vtk::starts,
        reader: super::vtk::read,
        extra_bytes: no_extra_bytes,
    },
    Format {
        name: "raw-f32x4",
        extensions: &[],
        about: "Raw numbers without a header: x, y, z, radius in little-endian f32",
        frames: None,
        needs_topology: false,
        may_lack_names: false,
        may_lack_radii: false,
        has_colors: false,
        starts: never,
        reader: |bytes, _| Ok(Loaded::new(raw::read_spheres(bytes)?)),
        extra_bytes: no_extra_bytes,
    },
];

fn never(_: &[u8]) -> bool {
    false
}

fn no_extra_bytes(_: &[u8]) -> Result<u64, LoadError> {
    Ok(0)
}
