//! Movies that the program ffmpeg compresses.

use std::io::{self, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;

use super::sink::{Samples, Sink};

/// Ends ffmpeg if the movie is not complete.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It has ended already if all went well.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Writes a movie to a file that exists, in a container that ffmpeg knows by this name.
pub(super) fn write(
    sink: &Sink<'_>,
    samples: &Samples<'_>,
    container: &str,
    path: &Path,
) -> io::Result<()> {
    let size = sink.size;
    // Compressed colours have half of the resolution, which needs sides of even lengths.
    let even = size.map(|side| side + side % 2);
    let [width, height] = even;
    let mut command = Command::new("ffmpeg");
    command.args([
        "-hide_banner",
        "-loglevel",
        "error",
        "-y",
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
    ]);
    command.args(["-s", &format!("{width}x{height}"), "-r", &sink.frames_per_second.to_string()]);
    command.args(["-i", "-", "-an", "-vf", "scale=out_color_matrix=bt709:out_range=tv"]);
    command.args(["-pix_fmt", "yuv420p", "-color_range", "tv", "-colorspace", "bt709"]);
    command.args(["-color_primaries", "bt709", "-color_trc", "iec61966-2-1"]);
    match container {
        "webm" => command.args(["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1"]),
        _ => command.args(["-c:v", "libx264", "-crf", "18"]),
    };
    if matches!(container, "mp4" | "mov") {
        command.args(["-movflags", "+faststart"]);
    }
    command.args(["-f", container]).arg(path);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    // Ctrl-C in a terminal is for this program, which ends ffmpeg itself.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let failed = |problem: String| io::Error::other(format!("ffmpeg {problem}"));
    let child = command.spawn().map_err(|error| failed(format!("cannot be started: {error}")))?;
    let mut running = Running(child);
    let (stdin, stderr) = (running.0.stdin.take(), running.0.stderr.take());
    thread::scope(|scope| {
        let said = scope.spawn(move || stderr.map_or(String::new(), last_words));
        let mut sent = match stdin {
            Some(stdin) => send(samples, size, stdin),
            None => Ok(()),
        };
        if let Err(error) = &sent
            && error.kind() != io::ErrorKind::BrokenPipe
        {
            // The pictures failed, not ffmpeg.
            let _ = running.0.kill();
            return sent;
        }
        let status = running.0.wait()?;
        let said = said.join().unwrap_or_default();
        if !status.success() {
            let why = if said.is_empty() { status.to_string() } else { said };
            return Err(failed(format!("failed: {why}")));
        }
        if sent.is_err() {
            sent = Err(failed("ended before the movie did".to_owned()));
        }
        sent
    })
}

fn send(samples: &Samples<'_>, size: [u32; 2], mut stdin: impl Write) -> io::Result<()> {
    while let Some(rgb) = samples.next()? {
        stdin.write_all(&with_even_sides(rgb, size))?;
    }
    stdin.flush()
}

/// Repeats the last column and the last row of RGB bytes where a side is odd.
fn with_even_sides(rgb: Vec<u8>, [width, height]: [u32; 2]) -> Vec<u8> {
    let row = 3 * width as usize;
    let mut even = rgb;
    if width % 2 == 1 {
        even =
            even.chunks_exact(row).flat_map(|row| [row, &row[row.len() - 3..]].concat()).collect();
    }
    if height % 2 == 1 {
        let row = 3 * (width + width % 2) as usize;
        even.extend_from_within(even.len() - row..);
    }
    even
}

/// The last line that a program says, of at most a few hundred characters.
fn last_words(mut stderr: impl Read) -> String {
    const MOST: usize = 1 << 12;
    let (mut tail, mut piece) = (Vec::new(), [0; 1 << 10]);
    while let Ok(read @ 1..) = stderr.read(&mut piece) {
        tail.extend_from_slice(&piece[..read]);
        let extra = tail.len().saturating_sub(MOST);
        tail.drain(..extra);
    }
    let text = String::from_utf8_lossy(&tail);
    let last = text.lines().rev().map(str::trim).find(|line| !line.is_empty());
    last.unwrap_or_default().chars().take(300).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_sides_get_a_pixel() {
        let rgb = vec![1, 2, 3, 4, 5, 6, 7, 8, 9];
        let row = [1, 2, 3, 4, 5, 6, 7, 8, 9, 7, 8, 9];
        assert_eq!(with_even_sides(rgb.clone(), [3, 1]), [row, row].concat());
        assert_eq!(with_even_sides(rgb[..6].to_vec(), [2, 1]), [&rgb[..6], &rgb[..6]].concat());
        assert_eq!(
            with_even_sides(rgb[..6].to_vec(), [1, 2]),
            [1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6]
        );
        let even = vec![0; 12];
        assert_eq!(with_even_sides(even.clone(), [2, 2]), even);
    }

    #[test]
    fn the_last_line_counts() {
        let text = format!("{}\nfirst\n  last \n\n", "x".repeat(10_000));
        assert_eq!(last_words(text.as_bytes()), "last");
        assert_eq!(last_words(&b""[..]), "");
    }
}
