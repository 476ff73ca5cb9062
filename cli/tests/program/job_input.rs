//! Jobs refuse bad input with one line, and overwrite nothing.

use crate::job::{folder, missing, part, through_parts};
use crate::support::Folder;

/// A job of four parts that is complete.
fn complete() -> Folder {
    let folder = folder();
    through_parts(
        &folder,
        "a.xyz --frames :2 --tiles 2x1 --size 40x30 --samples 2",
        "-o good%d.png",
    );
    folder
}

#[test]
fn wrong_usage_is_one_line() {
    let folder = complete();
    for (arguments, words) in [
        ("split a.xyz -o job", "this exists already"),
        ("split a.xyz -o no/job", "the folder no does not exist"),
        ("split a.xyz -o new --tiles 0x1", "write columns and rows"),
        ("split a.xyz -o new --tiles 4", "write columns and rows"),
        ("split a.xyz -o new --tiles 99999x1", "no room for so many tiles"),
        ("split a.xyz -o new --time 3", "choose --samples N"),
        ("split a.xyz -o new --noise 0.1", "choose --samples N"),
        ("split a.xyz -o new --frames : --resume", "belongs to `pinhole job merge`"),
        (
            "split a.xyz -o new --size 3000x2000 --tiles 2000x1000",
            "more than 1000000 units; choose fewer tiles or frames",
        ),
        ("split a.xyz -o new --layer deth", "there is no layer `deth`"),
        ("split a.xyz -o new --frames 9", "there is no frame 9"),
        ("split stereo.toml -o new --stereo two-files", "remove it"),
        ("split - --format xyz -o new", "name a file"),
        ("part job 4", "this job has 4 units, 0 to 3"),
        ("part job 2-9", "this job has 4 units, 0 to 3"),
        ("status job", "--missing"),
        ("part job x", "write an index"),
        ("part job 3-1", "write an index"),
        ("part job 0 --timeout 0", "greater than 0"),
        ("part job 0 --timeout nan", "greater than 0"),
        ("merge job -o m.png", "every frame needs a name of its own"),
        ("merge job -o m%d.jpg", "change the extension"),
        ("merge job -o m%d.exr", "split it with --exr"),
        ("merge job -o m%d.png --layer depth=d%d.npy", "split the job with --layer depth"),
        ("merge job -o no/m%d.png", "does not exist"),
        ("merge job -o m%d.png --wait -1", "at least 0"),
    ] {
        folder.refuses(&format!("job {arguments}"), 2, words);
    }
    folder.refuses("job split none.xyz -o new", 1, "none.xyz");
    folder.refuses("job part none 0", 1, "this is not the folder of a job");
}

/// Each file of a job missing, cut off, altered, or of another job or version.
#[test]
fn damaged_files_of_a_job_are_refused() {
    let folder = complete();
    let read = |name: &str| folder.read(name);
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path(name), bytes).unwrap();
    let merge = "job merge job -o bad%d.png";
    let all = ["job part job 0", "job status job --missing", merge];
    let good = read("job/job.json");
    let text = String::from_utf8(good.clone()).unwrap();
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    for (bytes, words) in [
        (good[..good.len() / 2].to_vec(), "this file is damaged"),
        (Vec::new(), "this file is damaged"),
        (b"{}".to_vec(), "this is not the file of a job"),
        (b"[1]".to_vec(), "this is not the file of a job"),
        (text.replace(&version, "\"version\": \"9.9.9\"").into(), "this job is of pinhole 9.9.9"),
        (text.replace("\"pinhole_job\": 1", "\"pinhole_job\": 2").into(), "use the same version"),
        (text.replace("\"samples\": 2", "\"samples\": 3").into(), "this file is damaged"),
        (text.replace("\"units\": 4", "\"units\": 40").into(), "this file is damaged"),
        (text.replace("\"samples\"", "\"sample\"").into(), "this file is damaged"),
    ] {
        write("job/job.json", &bytes);
        all.iter().for_each(|arguments| folder.refuses(arguments, 1, words));
    }
    std::fs::remove_file(folder.path("job/job.json")).unwrap();
    all.iter().for_each(|arguments| folder.refuses(arguments, 1, "not the folder of a job"));
    write("job/job.json", &good);
    // What all frames are together is needed only by parts that are not there.
    let overview = read("job/overview.bin");
    std::fs::remove_file(part(&folder, 0)).unwrap();
    for bytes in [&overview[8..], &[]] {
        write("job/overview.bin", bytes);
        folder.refuses("job part job 0", 1, "this file is damaged; split the job again");
    }
    std::fs::remove_file(folder.path("job/overview.bin")).unwrap();
    folder.refuses("job part job 0", 1, "overview.bin: cannot be read");
    write("job/overview.bin", &overview);
    // The data has changed, and is as long as before.
    let data = read("a.xyz");
    let mut other = data.clone();
    let last = other.iter().rposition(u8::is_ascii_digit).unwrap();
    other[last] ^= 1;
    write("a.xyz", &other);
    folder.refuses("job part job 0", 1, "a.xyz: this file has changed since the job was split");
    write("a.xyz", &data);
    folder.run("job part job 0 -q").succeeded();
    folder.run(&format!("{merge} -q")).succeeded();
    assert!(read("bad0.png") == read("good0.png") && read("bad1.png") == read("good1.png"));
}

#[test]
fn damaged_and_foreign_parts_are_refused_and_rendered_again() {
    let folder = complete();
    let good: Vec<Vec<u8>> =
        (0..4).map(|unit| std::fs::read(part(&folder, unit)).unwrap()).collect();
    let put = |unit: usize, bytes: &[u8]| std::fs::write(part(&folder, unit), bytes).unwrap();
    let flipped = |at: usize| {
        let mut bytes = good[0].clone();
        bytes[at] ^= 1;
        bytes
    };
    let end = good[0].len();
    // Any byte: of the start, the header's length, the header, the pixels, the digest.
    let mut damaged: Vec<Vec<u8>> =
        [0, 16, 20, 60, 200, end / 2, end - 33, end - 32, end - 1].map(flipped).to_vec();
    damaged.extend([vec![], good[0][..end / 2].to_vec(), good[0][..end - 1].to_vec()]);
    damaged.extend([[&good[0][..], b"x"].concat(), vec![0; end], b"pinhole part 1\n".to_vec()]);
    for bytes in damaged {
        put(0, &bytes);
        folder.refuses(
            "job merge job -o m%d.png",
            1,
            "damaged 0; render them again with --array=0",
        );
        assert_eq!(missing(&folder), [0]);
        folder.run("job part job 0 -q").succeeded();
        assert_eq!(missing(&folder), [0_usize; 0]);
    }
    // A part of another unit, and one of another job.
    put(2, &good[1]);
    folder.refuses("job merge job -o m%d.png", 1, "of another job 2; ");
    put(2, &good[2]);
    let other = complete();
    std::fs::remove_dir_all(other.path("job")).unwrap();
    through_parts(&other, "a.xyz --frames :2 --tiles 2x1 --size 40x30 --samples 3", "-o o%d.png");
    std::fs::copy(part(&other, 3), part(&folder, 3)).unwrap();
    folder.refuses("job merge job -o m%d.png", 1, "of another job 3; ");
    assert_eq!(missing(&folder), [3]);
    folder.run("job part job 3 -q").succeeded();
    folder.run("job merge job -o m%d.png -q").succeeded();
    assert!(folder.read("m1.png") == folder.read("good1.png"));
}
