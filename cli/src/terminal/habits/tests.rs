//! Tests of words that users type.

use super::*;

/// The only file that exists here is `Cargo.toml`.
fn plain(line: &str) -> Result<String, String> {
    let words = ["pinhole"].into_iter().chain(line.split(' ')).map(|word| word.replace('_', " ").into());
    let words = plain_words(words.collect()).map_err(|failure| failure.message())?;
    let words: Vec<String> = words[1..].iter().map(|word| word.to_string_lossy().replace(' ', "_")).collect();
    Ok(words.join(" "))
}

#[test]
fn values_follow_a_blank() {
    for (line, expected) in [
        ("render a.xyz --bonds 1.2 --legend top-right", "render a.xyz --bonds=1.2 --legend=top-right"),
        ("render --box 0.5 --ao 8 a.xyz --scale-bar 20_Å", "render --box=0.5 --ao=8 a.xyz --scale-bar=20_Å"),
        ("render --box Cargo.toml -o b.png", "render --box Cargo.toml -o b.png"),
        ("render --box gone.pdb -o b.png", "render --box gone.pdb -o b.png"),
        ("render --bonds 1.1 --scale-bar nm", "render --bonds=1.1 --scale-bar nm"),
        ("render --scale-bar gone.pdb --bonds 1.1", "render --scale-bar=gone.pdb --bonds 1.1"),
        ("render a.xyz --bonds --legend -o b.png", "render a.xyz --bonds --legend -o b.png"),
        ("render a.xyz --range 0 50 --frame -1", "render a.xyz --range=0,50 --frame=-1"),
        ("render --range 2% 98% a.xyz --eye 0 -1 8", "render --range=2%,98% a.xyz --eye=0,-1,8"),
        ("render --size 800 600 --view 30 20 7", "render --size=800,600 --view=30,20 7"),
        ("render a.xyz --no-denoise --no-legend", "render a.xyz --denoise=false"),
        ("a.xyz --no-box", "render a.xyz --box=false"),
        ("render a.xyz --outline --ao 4", "render a.xyz --outline=1.5 --ao=4"),
        ("render a.xyz --axes off --box none --legend no", "render a.xyz --box=false"),
        ("render a.xyz -- --bonds 1", "render a.xyz -- --bonds 1"),
        ("info Cargo.toml --bonds 1", "info Cargo.toml --bonds 1"),
        ("job split a.xyz --bonds 1", "job split a.xyz --bonds=1"),
    ] {
        assert_eq!(plain(line).as_deref(), Ok(expected), "{line}");
    }
}

#[test]
fn a_file_alone_is_rendered() {
    for (line, expected) in [
        ("Cargo.toml --style fast", "render Cargo.toml --style=fast"),
        ("gone.pdb", "render gone.pdb"),
        ("--ortho a.pdb", "render --camera=orthographic a.pdb"),
        ("--wrap a.pdb", "render --replicate=wrap a.pdb"),
        ("Cargo.toml@-1", "render Cargo.toml --frame=-1"),
        ("Cargo.toml@::5", "render Cargo.toml --frames=::5"),
        ("Cargo.toml@home", "render Cargo.toml@home"),
        ("-o b.png a.pdb", "render -o b.png a.pdb"),
        ("--help", "--help"),
        ("-V", "-V"),
        ("rendr", "rendr"),
        ("job", "job"),
        ("job a.pdb", "job a.pdb"),
    ] {
        assert_eq!(plain(line).as_deref(), Ok(expected), "{line}");
    }
}

#[test]
fn other_names_have_the_meaning_of_flags() {
    for (line, expected) in [
        ("a.xyz --out b.png --bg black --colorbar top", "a.xyz --output=b.png --background=black --legend=top"),
        ("a.xyz --colour red --title me@home", "a.xyz --color=red --label=me@home@top"),
        ("a.xyz --color chain", "a.xyz --color-by=chain"),
        ("a.xyz --color gren", "a.xyz --color=gren"),
        ("a.xyz --only protein --exclude element_H", "a.xyz --select=(protein)_and_not_(element_H)"),
        ("a.xyz --slice z=3:9 --slice x=:2", "a.xyz --select=3_<=_z_<=_9_and_x_<=_2"),
        ("a.xyz --slice z<7", "a.xyz --select=z<7"),
        ("a.xyz --cartoon --no-water", "a.xyz --show=cartoon --hide=water"),
        ("a.xyz --cartoon --sticks resn_HEM -o b.png", "a.xyz --show=cartoon --show=resn_HEM_=_sticks -o b.png"),
        ("a.xyz --style licorice --perspective", "a.xyz --show=licorice --camera=pinhole"),
        ("a.xyz --rep cpk --view perspective", "a.xyz --show=cpk --camera=pinhole"),
        ("a.xyz --sel all --delete name_CA --no-cell", "a.xyz --box=false --select=(all)_and_not_(name_CA)"),
        ("a.xyz --color-by-chain --supercell 2 2 1", "a.xyz --color-by=chain --replicate=2,2,1"),
        ("a.xyz --background transparent --center protein", "a.xyz --transparent --focus=protein"),
        ("a.xyz --style NewCartoon_0.3_10 --bg-color white", "a.xyz --show=NewCartoon --background=white"),
        ("a.xyz --zoom protein --radius size --no-axes", "a.xyz --focus=protein --radius-by=size"),
        ("a.xyz --hide water --style sticks --show C=points", "a.xyz --show=sticks --hide=water --show=C=points"),
        ("a.xyz --transparency 0.75 --show-unit-cell 2", "a.xyz --opacity=0.25 --box"),
        ("a.xyz --show-unit-cell 0 --camera ortho", "a.xyz --box=false --camera=orthographic"),
        ("a.xyz --vmin 2", "a.xyz --range=2,"),
        ("a.xyz --vmax 5 --vmin -1", "a.xyz --range=-1,5"),
        ("a.xyz --every 5", "a.xyz --frames=::5"),
        ("a.xyz --every 5 --frames 10:90", "a.xyz --frames=10:90:5"),
        ("a.xyz --width 900", "a.xyz --size=900"),
        ("a.xyz -s 400x300 --repeat 2 2 1", "a.xyz --size=400x300 --replicate=2,2,1"),
        ("a.xyz --unit-cell --alpha 0.5", "a.xyz --box --opacity=0.5"),
        ("a.xyz --height 600", "a.xyz --size=800x600"),
        ("a.gro --zoom 2 a.xtc", "--topology=a.gro --zoom=2 a.xtc"),
        ("a.dcd a.pdb", "a.dcd --topology=a.pdb"),
        ("a.xyz --height 60 --width 50", "a.xyz --size=50x60"),
    ] {
        assert_eq!(plain(&format!("render {line}")), Ok(format!("render {expected}")), "{line}");
    }
    assert_eq!(plain("info a.xyz --width 9").as_deref(), Ok("info a.xyz --width 9"));
}

#[test]
fn words_without_a_meaning_are_refused() {
    for (line, words) in [
        ("--select resname HEM", "`HEM` is no file; quote it: --select 'resname HEM'"),
        ("--show protein = trace", "`=` is no file; quote it: --show 'protein = trace'"),
        ("--exclude name CA or water -o b.png", "`CA` is no file; quote it: --exclude 'name CA or water'"),
        ("--rotate 30", "--rotate: --view AZIMUTH,ELEVATION in degrees says from where, such as --view 30,20"),
        (
            "Cargo.toml",
            "Cargo.toml: only files of data, without commas and braces in their names, are seen together; render each file",
        ),
        ("--clip x<5", "--clip: spheres are not cut; --select 'x < 5' keeps a part"),
        ("--slice z", "--slice z: write AXIS=LOW:HIGH, such as z=3:9, which keeps whole spheres"),
        ("--height x", "--height x: write a whole number"),
        ("--every", "--every needs a value"),
        ("--cmap --log", "--cmap needs a value; `pinhole render --help` says which"),
        ("--ptm", "--ptm: structures are not analyzed; add a column to the file, which --color-by draws"),
        (
            "--color A=red,B=blue",
            "--color A=red,B=blue: this is one color for all; for a part: --show 'SELECTION = spacefill, color=VALUE', and for \
             each kind: --set 'elements.NAME.color=VALUE'",
        ),
        ("--center -o b.png", "--center: pictures are centered on what they show; leave it out"),
        ("--delete -o b.png", "--exclude needs a value"),
        ("--scale 40", "--scale 40: --size WIDTHxHEIGHT is that of the picture, and --radius-scale multiplies radii"),
        (
            "--select protein --select water",
            "--select twice: join them with `or`; --show 'protein = trace' --show 'resname HEM = sticks' draws parts otherwise",
        ),
        ("--select -o b.png", "--select needs a value; `pinhole render --help` says which"),
        ("-i b.png", "-i: name the file alone; --frame -1 chooses a frame"),
        (
            "--label %e%i",
            "--label %e%i: texts at atoms, or of frames, are not drawn; --label TEXT writes a text at a place of the picture",
        ),
        ("--chain A", "--chain: --select EXPRESSION keeps a part, such as --select 'chain A and resname HEM'"),
    ] {
        assert_eq!(plain(&format!("render Cargo.toml {line}")), Err(words.to_owned()), "{line}");
    }
    let words = plain("render --only resname HEM Cargo.toml").unwrap_err();
    assert!(words.starts_with("`HEM` is no file"), "{words}");
    assert_eq!(plain("render --select protein gone.pdb").as_deref(), Ok("render --select=protein gone.pdb"));
}
