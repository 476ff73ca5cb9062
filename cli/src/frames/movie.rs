//! Writes several pictures on a separate thread, as files or as a movie in one of its formats.

use std::io::{self, BufWriter, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::Receiver;
use std::thread;

use anyhow::{Context, Result};
use gif::{Encoder, Frame, Repeat};
use png::{BitDepth, ColorType, Compression, Filter, SrgbRenderingIntent};

use crate::frames::args::numbered;
use crate::frames::target::{Movie, Target};
use crate::output::files::{name_all, unnamed_with};
use crate::output::picture::Outputs;
use crate::terminal::interrupt;
use pinhole::image::Image;
use pinhole::image::encoding::{Bits, Encoding};
use pinhole_figure::write::png::samples_annotated;

/// The message if the program is stopped after some frames are complete.
pub(crate) const STOPPED_BETWEEN: &str =
    "stopped; the frames that were written are complete, and --resume goes on after them";

/// A message to the thread that writes.
pub(crate) enum Message {
    Picture {
        number: usize,
        image: Box<Image>,
    },
    /// There are no more pictures. Without it, a movie is not complete.
    End,
}

pub(crate) struct Sink<'a> {
    pub(crate) target: &'a Target,
    pub(crate) outputs: &'a Outputs,
    pub(crate) encoding: &'a Encoding,
    pub(crate) adapter: Option<&'a str>,
    pub(crate) frames_per_second: u32,
    /// The total number of pictures.
    pub(crate) count: usize,
    pub(crate) size: [u32; 2],
}

/// The samples of the pictures of a movie, one after the other.
pub(crate) struct Samples<'a> {
    pub(crate) pictures: &'a Receiver<Message>,
    pub(crate) sink: &'a Sink<'a>,
}

impl Samples<'_> {
    /// Returns the samples of the next picture; `None` after the last. An error means that the movie is not complete.
    pub(crate) fn next(&self) -> io::Result<Option<Vec<u8>>> {
        match self.pictures.recv() {
            Ok(Message::Picture { image, .. }) => {
                let Sink { encoding, outputs, .. } = self.sink;
                let samples = samples_annotated(&image, encoding, &outputs.annotations);
                samples.map(Some).map_err(io::Error::other)
            }
            Ok(Message::End) => Ok(None),
            Err(_) => Err(io::Error::other("not all pictures were rendered")),
        }
    }
}

impl Sink<'_> {
    pub(crate) fn write(&self, pictures: &Receiver<Message>) -> Result<()> {
        let samples = Samples { pictures, sink: self };
        match self.target {
            Target::Files { .. } => self.write_files(pictures),
            Target::Raw => {
                interrupt::set_message("stopped; the movie on standard output is not complete");
                write_y4m(self, &samples).context("standard output: cannot be written")
            }
            Target::Movie { path, kind } => {
                let file = unnamed_with(path, |file| match kind {
                    Movie::Apng => write_apng(self, &samples, file),
                    Movie::Gif => write_gif(self, &samples, file),
                    Movie::Video(container) => write_video(self, &samples, container, file.path()),
                })?;
                name_all(vec![(path, file)])
            }
        }
    }

    fn write_files(&self, pictures: &Receiver<Message>) -> Result<()> {
        while let Ok(Message::Picture { number, image }) = pictures.recv() {
            let outputs = self.outputs.renamed(|path| numbered(path, number));
            outputs.write(&image, self.encoding, self.adapter, None)?;
            interrupt::set_message(STOPPED_BETWEEN);
        }
        Ok(())
    }
}

/// Writes an APNG that repeats endlessly.
pub(crate) fn write_apng(sink: &Sink<'_>, samples: &Samples<'_>, file: impl Write) -> io::Result<()> {
    let failed = |error: png::EncodingError| match error {
        png::EncodingError::IoError(error) => error,
        error => io::Error::other(error),
    };
    let [width, height] = sink.size;
    let mut encoder = png::Encoder::new(BufWriter::new(file), width, height);
    let is_transparent = sink.encoding.transparent;
    encoder.set_color(if is_transparent { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(match sink.encoding.bits {
        Bits::Sixteen => BitDepth::Sixteen,
        _ => BitDepth::Eight,
    });
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    let count = u32::try_from(sink.count).map_err(io::Error::other)?;
    encoder.set_animated(count, 0).map_err(failed)?;
    // The number is at most 240, the limit of the flag.
    let per_second = u16::try_from(sink.frames_per_second).unwrap_or(u16::MAX);
    encoder.set_frame_delay(1, per_second).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    while let Some(picture) = samples.next()? {
        writer.write_image_data(&picture).map_err(failed)?;
    }
    writer.finish().map_err(failed)
}

/// The speed at which palettes are chosen, from 1 (looks at all of the picture, slow) to 30.
const SPEED: i32 = 10;

/// Writes a GIF that repeats endlessly.
pub(crate) fn write_gif(sink: &Sink<'_>, samples: &Samples<'_>, file: impl Write) -> io::Result<()> {
    let failed = |error: gif::EncodingError| match error {
        gif::EncodingError::Io(error) => error,
        error => io::Error::other(error),
    };
    // The size was checked before.
    let [width, height] = sink.size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
    let mut out = BufWriter::new(file);
    let mut encoder = Encoder::new(&mut out, width, height, &[]).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    let mut index = 0;
    while let Some(picture) = samples.next()? {
        let mut frame = Frame::from_rgb_speed(width, height, &picture, SPEED);
        frame.delay = delay(index, sink.frames_per_second);
        encoder.write_frame(&frame).map_err(failed)?;
        index += 1;
    }
    drop(encoder);
    out.flush()
}

/// The time for which a picture is shown, in hundredths of a second. Times are rounded so that their sum is right.
fn delay(index: u64, per_second: u32) -> u16 {
    let ends_at = |index: u64| (index * 100 + u64::from(per_second) / 2) / u64::from(per_second);
    u16::try_from(ends_at(index + 1) - ends_at(index)).unwrap_or(u16::MAX)
}

/// Ends ffmpeg when it is dropped, if the movie is not complete.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // After success, ffmpeg has already ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Writes a movie to an existing file. `container` is the name that ffmpeg has for its format.
pub(crate) fn write_video(sink: &Sink<'_>, samples: &Samples<'_>, container: &str, path: &Path) -> io::Result<()> {
    let size = sink.size;
    // Compressed colours have half the resolution, so sides must have even lengths.
    let even = size.map(|side| side + side % 2);
    let [width, height] = even;
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error", "-y"]);
    command.args(["-f", "rawvideo", "-pix_fmt", "rgb24"]);
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
    // Ctrl-C in a terminal should reach only this program, which ends ffmpeg itself.
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
            // The error comes from the pictures, not from ffmpeg.
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

/// Repeats the last column and the last row of RGB bytes if a side is odd.
fn with_even_sides(rgb: Vec<u8>, [width, height]: [u32; 2]) -> Vec<u8> {
    let row = 3 * width as usize;
    let mut even = rgb;
    if width % 2 == 1 {
        even = even.chunks_exact(row).flat_map(|row| [row, &row[row.len() - 3..]].concat()).collect();
    }
    if height % 2 == 1 {
        let row = 3 * (width + width % 2) as usize;
        even.extend_from_within(even.len() - row..);
    }
    even
}

/// The last line that a program printed, cut to a few hundred characters.
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

/// Writes pictures with full resolution of colour, in the limited range of ITU-R BT.601, which readers assume.
pub(crate) fn write_y4m(sink: &Sink<'_>, samples: &Samples<'_>) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match write_to(sink, samples, &mut out).and_then(|()| out.flush()) {
        // The reader has closed the pipe because it needs no more.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

fn write_to(sink: &Sink<'_>, samples: &Samples<'_>, out: &mut impl Write) -> io::Result<()> {
    let ([width, height], per_second) = (sink.size, sink.frames_per_second);
    writeln!(out, "YUV4MPEG2 W{width} H{height} F{per_second}:1 Ip A1:1 C444 XCOLORRANGE=LIMITED")?;
    while let Some(rgb) = samples.next()? {
        out.write_all(b"FRAME\n")?;
        out.write_all(&planes(&rgb))?;
    }
    Ok(())
}

/// The planes Y, Cb and Cr of a picture of RGB bytes, one after the other.
fn planes(rgb: &[u8]) -> Vec<u8> {
    let pixels = rgb.len() / 3;
    let mut planes = vec![0; 3 * pixels];
    for (index, pixel) in rgb.chunks_exact(3).enumerate() {
        for (plane, value) in yuv([pixel[0], pixel[1], pixel[2]]).into_iter().enumerate() {
            planes[plane * pixels + index] = value;
        }
    }
    planes
}

fn yuv(rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|c| f32::from(c) / 255.0);
    let y = 0.299 * r + 0.587 * g + 0.114 * b;
    let (cb, cr) = ((b - y) / 1.772, (r - y) / 1.402);
    [16.0 + 219.0 * y, 128.0 + 224.0 * cb, 128.0 + 224.0 * cr].map(|v| v.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_takes_a_second() {
        for per_second in [1, 7, 24, 25, 30, 60, 240] {
            let sum: u32 = (0..u64::from(per_second)).map(|i| u32::from(delay(i, per_second))).sum();
            assert_eq!(sum, 100, "{per_second}");
        }
        assert_eq!(delay(5, 25), 4);
    }

    #[test]
    fn odd_sides_get_a_pixel() {
        let rgb = vec![1, 2, 3, 4, 5, 6, 7, 8, 9];
        let row = [1, 2, 3, 4, 5, 6, 7, 8, 9, 7, 8, 9];
        assert_eq!(with_even_sides(rgb.clone(), [3, 1]), [row, row].concat());
        assert_eq!(with_even_sides(rgb[..6].to_vec(), [2, 1]), [&rgb[..6], &rgb[..6]].concat());
        assert_eq!(with_even_sides(rgb[..6].to_vec(), [1, 2]), [1, 2, 3, 1, 2, 3, 4, 5, 6, 4, 5, 6]);
        let even = vec![0; 12];
        assert_eq!(with_even_sides(even.clone(), [2, 2]), even);
    }

    #[test]
    fn the_last_line_counts() {
        let text = format!("{}\nfirst\n  last \n\n", "x".repeat(10_000));
        assert_eq!(last_words(text.as_bytes()), "last");
        assert_eq!(last_words(&b""[..]), "");
    }

    /// The expected values are those of the standard.
    #[test]
    fn colors_are_those_of_bt_601() {
        for (rgb, expected) in [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [81, 90, 240]),
            ([0, 255, 0], [145, 54, 34]),
            ([0, 0, 255], [41, 240, 110]),
        ] {
            assert_eq!(yuv(rgb), expected, "{rgb:?}");
        }
        assert_eq!(planes(&[255, 255, 255, 0, 0, 0]), [235, 16, 128, 128, 128, 128]);
    }
}
