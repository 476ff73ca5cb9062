//! The certificate that a picture carries in its file.
//!
//! The certificate is a text with a key and a value on each line. Any tool shows it that shows texts of PNG files or
//! attributes of OpenEXR files:
//!
//! | key | value |
//! |---|---|
//! | `pinhole-certificate` | version of this format, [`VERSION`] |
//! | `version` | version of this crate |
//! | `adapter` | the adapter that rendered, or `cpu` |
//! | `setting` | a setting that the command line gave, as its flag; one line for each |
//! | `scene-sha256` | digest of the scene's data, [`scene_digest`] |
//! | `samples-sha256` | digest of the picture's size and samples, [`samples_digest`] |
//! | `outcome` | `proved` or `undecided` |
//! | `exact`, `legal`, `wide`, `open` | numbers of pixels with these verdicts |
//! | `sha256` | digest of all lines before |
//!
//! A digest reveals changes by mistake. It is not a signature: a person who changes a picture on purpose can also
//! compute digests. So `verify` takes nothing else from the certificate than what the picture should be, and judges every
//! pixel itself. The adapter and the version are hearsay.

use bytemuck::{bytes_of, cast_slice};
use sha2::{Digest, Sha256};

use super::run_file::hex;
use crate::scene::Scene;
use crate::text::{one_line, shortened};
use crate::verify::certificate::Outcome;

/// The version of the format that this crate writes, and the only one that it reads.
pub const VERSION: &str = "2";

/// The first key.
const FIRST: &str = "pinhole-certificate";

/// The keys of the numbers of pixels.
const COUNTS: [&str; 4] = ["exact", "legal", "wide", "open"];

/// The last key.
const DIGEST: &str = "sha256";

/// The certificate that a picture carries in its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureCertificate {
    /// Version of the crate that wrote the certificate.
    pub version: String,
    /// The adapter that rendered, or `cpu`.
    pub adapter: String,
    /// The settings that the command line gave, each as the name of its flag without dashes, and its value.
    pub settings: Vec<[String; 2]>,
    /// The digest of the scene's data.
    pub scene: String,
    /// The digest of the samples.
    pub samples: String,
    /// The outcome of the check.
    pub outcome: Outcome,
    /// The numbers of pixels that are exact, legal, wide and open.
    pub counts: [u64; 4],
}

/// Why a text is not a certificate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct CertificateError(String);

fn missing(key: &str) -> CertificateError {
    CertificateError(format!(
        "the picture's certificate has no valid line `{key}`; render the picture again with --certify"
    ))
}

impl PictureCertificate {
    /// The text of the certificate, in ASCII.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = format!("{FIRST} {VERSION}\n");
        let mut line = |key: &str, value: &str| {
            // Characters beyond ASCII are written as in Rust's strings, because PNG and OpenEXR have only Latin-1.
            text.extend([key, " "]);
            for c in value.chars() {
                match c {
                    '\\' => text.push_str("\\\\"),
                    ' '..='~' => text.push(c),
                    c => text.extend(c.escape_unicode()),
                }
            }
            text.push('\n');
        };
        line("version", &one_line(&self.version));
        line("adapter", &one_line(&self.adapter));
        for [name, value] in &self.settings {
            line("setting", &format!("{name} {value}"));
        }
        line("scene-sha256", &self.scene);
        line("samples-sha256", &self.samples);
        line("outcome", self.outcome.name());
        for (key, count) in COUNTS.into_iter().zip(self.counts) {
            line(key, &count.to_string());
        }
        let digest = hex(Sha256::new_with_prefix(&text));
        text + &format!("{DIGEST} {digest}\n")
    }

    /// Reads the text of a certificate.
    ///
    /// # Errors
    /// Returns an error if the text is of another version, was edited, or lacks a line.
    pub fn from_text(text: &str) -> Result<Self, CertificateError> {
        let mut lines = text.lines().map(|line| line.split_once(' ').unwrap_or((line, "")));
        match lines.next() {
            Some((FIRST, VERSION)) => {}
            Some((FIRST, other)) => {
                return Err(CertificateError(format!(
                    "the picture's certificate has the version {}, and this program reads version {VERSION}; use the \
                     program that wrote it, or render the picture again",
                    shortened(&one_line(other))
                )));
            }
            _ => return Err(missing(FIRST)),
        }
        let before = text.rfind(&format!("\n{DIGEST} ")).ok_or(missing(DIGEST))? + 1;
        let digest = format!("{DIGEST} {}\n", hex(Sha256::new_with_prefix(&text.as_bytes()[..before])));
        if text[before..] != digest {
            let message = "the picture's certificate was edited: its SHA-256 digest does not match; render the picture \
                           again with --certify";
            return Err(CertificateError(message.to_owned()));
        }
        let lines: Vec<(&str, String)> = lines.map(|(key, value)| (key, unescaped(value))).collect();
        let all =
            |key: &'static str| lines.iter().filter(move |(found, _)| *found == key).map(|(_, value)| value.clone());
        let one = |key| all(key).next().ok_or(missing(key));
        let number = |key| one(key)?.parse::<u64>().map_err(|_| missing(key));
        let outcome = one("outcome")?;
        Ok(Self {
            version: one("version")?,
            adapter: one("adapter")?,
            settings: all("setting")
                .map(|setting| setting.split_once(' ').map(|(name, value)| [name, value].map(str::to_owned)))
                .collect::<Option<_>>()
                .ok_or(missing("setting"))?,
            scene: one("scene-sha256")?,
            samples: one("samples-sha256")?,
            outcome: [Outcome::Proved, Outcome::Undecided]
                .into_iter()
                .find(|known| known.name() == outcome)
                .ok_or(missing("outcome"))?,
            counts: [number(COUNTS[0])?, number(COUNTS[1])?, number(COUNTS[2])?, number(COUNTS[3])?],
        })
    }
}

/// Reverses the escapes of [`PictureCertificate::to_text`]. Other text stays as it is.
fn unescaped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\\') {
        result.push_str(before);
        let code = after.strip_prefix("u{").and_then(|after| after.split_once('}'));
        let escape =
            code.and_then(|(digits, after)| Some((char::from_u32(u32::from_str_radix(digits, 16).ok()?)?, after)));
        let (c, after) = match escape {
            Some(escape) => escape,
            None => ('\\', after.strip_prefix('\\').unwrap_or(after)),
        };
        result.push(c);
        rest = after;
    }
    result + rest
}

/// The digest of a scene's data: origin, shapes, colours and surfaces, in hexadecimal digits.
#[must_use]
pub fn scene_digest(scene: &Scene) -> String {
    let mut digest = Sha256::new();
    // Numbers have the lowest byte first in memory too, as run files need (`run_file/container.rs`).
    digest.update(bytes_of(&scene.origin().to_array()));
    for (id, sphere) in (0..).zip(scene.spheres()) {
        digest.update(bytes_of(sphere));
        digest.update(bytes_of(&scene.color(id).to_array()));
    }
    for (id, cone) in (scene.len() as u32..).zip(scene.cones()) {
        digest.update("cone");
        digest.update(bytes_of(cone));
        digest.update(bytes_of(&scene.color(id).to_array()));
    }
    let appearance = scene.appearance();
    digest.update(format!("{:?}", appearance.surfaces()));
    digest.update(cast_slice::<u32, u8>(appearance.surface_indices().unwrap_or_default()));
    hex(digest)
}

/// The digest of the samples of a picture: width and height in four bytes each, the lowest byte first,
/// and then the samples as in the file.
#[must_use]
pub fn samples_digest(size: [u32; 2], samples: &[u8]) -> String {
    let mut digest = Sha256::new();
    size.iter().for_each(|side| digest.update(side.to_le_bytes()));
    digest.update(samples);
    hex(digest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn certificate() -> PictureCertificate {
        PictureCertificate {
            version: "0.1.0".into(),
            adapter: "a device".into(),
            settings: [("eye", "1,2,3"), ("label", "grün\n\\u{41} \\.@top"), ("label", "")]
                .map(|(name, value)| [name, value].map(str::to_owned))
                .to_vec(),
            scene: "aa".into(),
            samples: "bb".into(),
            outcome: Outcome::Undecided,
            counts: [190, 2, 1, 0],
        }
    }

    #[test]
    fn a_certificate_is_read_as_it_was_written() {
        let text = certificate().to_text();
        assert!(text.is_ascii(), "{text}");
        assert_eq!(PictureCertificate::from_text(&text), Ok(certificate()));
    }

    #[test]
    fn every_edit_is_noticed() {
        let text = certificate().to_text();
        for index in 0..text.len() {
            let mut edited = text.clone().into_bytes();
            edited[index] ^= 1;
            let edited = String::from_utf8(edited).unwrap();
            assert!(PictureCertificate::from_text(&edited).is_err(), "{index}: {edited}");
            assert!(PictureCertificate::from_text(&text[..index]).is_err(), "{index}");
        }
        let refused = |text: &str| PictureCertificate::from_text(text).unwrap_err().to_string();
        let other = refused(&text.replace("certificate 2", "certificate 1"));
        assert!(other.starts_with("the picture's certificate has the version 1, and this"), "{other}");
        assert_eq!(refused(""), missing(FIRST).to_string());
    }
}
