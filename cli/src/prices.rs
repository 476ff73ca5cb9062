//! Measured prices of adapters, kept in the user's folder for caches. A file that is of no use is ignored with a note.

use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use serde::{Deserialize, Serialize};

use pinhole::accel::{Prices, StructurePrices};
use pinhole::gpu::Headless;
use pinhole::gpu::wgpu::{AdapterInfo, DeviceType};

/// Raised when the file or the meaning of a price changes, for example because kernels do other work.
const VERSION: u32 = 1;

/// No file of prices is larger.
const MOST_BYTES: u64 = 1 << 20;

/// No price, in nanoseconds, is larger.
const HIGHEST: f64 = 1e9;

/// Where the prices come from, by which structures are chosen.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PriceSource {
    /// [`Prices::SOFTWARE`] or [`Prices::GPU`].
    BuiltIn(DeviceType),
    /// Measured on this day, such as 2026-11-22.
    Measured(String),
}

/// The file.
#[derive(Debug, Deserialize, Serialize)]
struct Kept {
    version: u32,
    adapters: Vec<KeptAdapter>,
}

/// The prices of an adapter with a driver.
#[derive(Clone, Debug, Deserialize, Serialize)]
struct KeptAdapter {
    name: String,
    backend: String,
    driver: String,
    driver_info: String,
    measured_on: String,
    /// In nanoseconds.
    prices: KeptPrices,
}

impl KeptAdapter {
    fn adapter(&self) -> [&String; 2] {
        [&self.name, &self.backend]
    }

    fn driver(&self) -> [&String; 2] {
        [&self.driver, &self.driver_info]
    }
}

#[derive(Clone, Debug, Deserialize, Serialize)]
struct KeptPrices {
    references: KeptStructure,
    balls: KeptStructure,
    tree: KeptStructure,
    upload_byte: f64,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
struct KeptStructure {
    ray: f64,
    step: f64,
    element: f64,
    sphere: f64,
    build: f64,
}

/// Gives a device the prices that were measured for it, if there are such. Returns a note if a file is of no use.
pub(super) fn use_measured(headless: &mut Headless) -> (PriceSource, Option<String>) {
    let info = headless.adapter_info();
    let built_in = PriceSource::BuiltIn(info.device_type);
    let Some(path) = path() else { return (built_in, None) };
    match find(&path, info) {
        Ok(Some((prices, day))) => {
            headless.set_prices(prices);
            (PriceSource::Measured(day), None)
        }
        Ok(None) => (built_in, None),
        Err(why) => (
            built_in,
            Some(format!(
                "{}: {why}; these prices are not used; measure them again with `pinhole bench --calibrate`, or remove \
                 the file",
                path.display()
            )),
        ),
    }
}

/// Where the prices of an adapter come from, without a device.
pub(super) fn source(info: &AdapterInfo) -> PriceSource {
    let found = path().and_then(|path| find(&path, info).ok().flatten());
    found.map_or(PriceSource::BuiltIn(info.device_type), |(_, day)| PriceSource::Measured(day))
}

impl PriceSource {
    /// The words in reports.
    pub(super) fn words(&self) -> String {
        match self {
            Self::BuiltIn(DeviceType::Cpu) => "built-in, for software devices".to_owned(),
            Self::BuiltIn(_) => {
                "built-in, for GPUs; `pinhole bench --calibrate` measures this one".to_owned()
            }
            Self::Measured(day) => format!("measured on {day}"),
        }
    }
}

/// The file; `None` if there is no folder for caches. `XDG_CACHE_HOME` is followed on every system.
pub(super) fn path() -> Option<PathBuf> {
    let asked = std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from);
    let folder = match asked.filter(|folder| folder.is_absolute()) {
        Some(folder) => folder,
        None => etcetera::base_strategy::choose_native_strategy().ok()?.cache_dir(),
    };
    Some(folder.join("pinhole").join("prices.json"))
}

/// The prices of the adapter with this driver and the day of their measurement; `None` if it was never measured. The
/// error says what is wrong with the file.
fn find(path: &Path, info: &AdapterInfo) -> Result<Option<(Prices, String)>, String> {
    let Some(kept) = read(path)? else { return Ok(None) };
    let backend = format!("{:?}", info.backend);
    let is_adapter = |kept: &&KeptAdapter| kept.adapter() == [&info.name, &backend];
    let is_driver = |kept: &&KeptAdapter| kept.driver() == [&info.driver, &info.driver_info];
    let mut all = kept.adapters.iter().filter(is_adapter).peekable();
    let Some(first) = all.peek().copied() else { return Ok(None) };
    let Some(found) = all.find(is_driver) else {
        return Err(format!(
            "measured for {} with the driver {} {}, but the driver is {} {}",
            first.name, first.driver, first.driver_info, info.driver, info.driver_info
        ));
    };
    let damaged = || "damaged: a price is not a number of nanoseconds".to_owned();
    let prices = found.prices.checked().ok_or_else(damaged)?;
    Ok(Some((prices, found.measured_on.clone())))
}

fn read(path: &Path) -> Result<Option<Kept>, String> {
    let unreadable = |error: std::io::Error| format!("cannot be read: {error}");
    let file = match std::fs::File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(unreadable(error)),
    };
    let mut bytes = Vec::new();
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("damaged: it is larger than {MOST_BYTES} bytes"));
    }
    #[derive(Deserialize)]
    struct Versioned {
        version: u32,
    }
    let damaged = |error: serde_json::Error| format!("damaged: {error}");
    // The version first: the rest of another version may look different.
    let Versioned { version } = serde_json::from_slice(&bytes).map_err(damaged)?;
    if version != VERSION {
        return Err(format!("written by another version of pinhole ({version}, not {VERSION})"));
    }
    serde_json::from_slice(&bytes).map(Some).map_err(damaged)
}

/// Keeps the prices of an adapter beside those of others. The error says why that is not possible.
pub(super) fn keep(
    path: &Path,
    info: &AdapterInfo,
    prices: &Prices,
    day: &str,
) -> Result<(), String> {
    let kept = KeptAdapter {
        name: info.name.clone(),
        backend: format!("{:?}", info.backend),
        driver: info.driver.clone(),
        driver_info: info.driver_info.clone(),
        measured_on: day.to_owned(),
        prices: KeptPrices::of(prices),
    };
    // A file that is of no use is replaced.
    let mut adapters = read(path).ok().flatten().map_or_else(Vec::new, |kept| kept.adapters);
    adapters.retain(|other| other.adapter() != kept.adapter() || other.driver() != kept.driver());
    adapters.push(kept);
    let kept = Kept { version: VERSION, adapters };
    let text = serde_json::to_string_pretty(&kept).map_err(|error| error.to_string())? + "\n";
    let folder = path.parent().unwrap_or(Path::new("."));
    let write = || {
        std::fs::create_dir_all(folder)?;
        // Another process never reads half a file.
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        file.write_all(text.as_bytes())?;
        file.persist(path).map(drop).map_err(|error| error.error)
    };
    write().map_err(|error: std::io::Error| error.to_string())
}

impl KeptPrices {
    fn of(prices: &Prices) -> Self {
        let kept = |prices: &StructurePrices| KeptStructure {
            ray: prices.ray,
            step: prices.step,
            element: prices.element,
            sphere: prices.sphere,
            build: prices.build,
        };
        Self {
            references: kept(&prices.references),
            balls: kept(&prices.balls),
            tree: kept(&prices.tree),
            upload_byte: prices.upload_byte,
        }
    }

    /// The prices, if all are within range.
    fn checked(&self) -> Option<Prices> {
        let of = |kept: &KeptStructure| {
            let KeptStructure { ray, step, element, sphere, build } = *kept;
            let is_price = |price: f64| (0.0..=HIGHEST).contains(&price);
            let all = [ray, step, element, sphere, build, self.upload_byte].map(is_price);
            all.iter().all(|is_price| *is_price).then_some([ray, step, element, sphere, build])
        };
        let mut prices = Prices::SOFTWARE;
        let structures = [&mut prices.references, &mut prices.balls, &mut prices.tree].into_iter();
        for (target, kept) in structures.zip([&self.references, &self.balls, &self.tree]) {
            [target.ray, target.step, target.element, target.sphere, target.build] = of(kept)?;
        }
        prices.upload_byte = self.upload_byte;
        Some(prices)
    }
}

/// The day of the present in UTC, such as 2026-11-22.
pub(super) fn today() -> String {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    day_of(now.map_or(0, |since| since.as_secs()) / 86_400)
}

/// The date of a day after 1970-01-01, by the rule of the Gregorian calendar.
fn day_of(days: u64) -> String {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let (mut year, mut left) = (1970, days);
    while left >= 365 + u64::from(is_leap(year)) {
        left -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if left < length {
            break;
        }
        left -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", left + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(name: &str, driver_info: &str) -> AdapterInfo {
        let mut info = AdapterInfo::new(DeviceType::Cpu, pinhole::gpu::wgpu::Backend::Vulkan);
        info.name = name.to_owned();
        info.driver = "driver".to_owned();
        info.driver_info = driver_info.to_owned();
        info
    }

    fn file() -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep").join("prices.json");
        (folder, path)
    }

    #[test]
    fn prices_are_kept_for_each_adapter() {
        let (_folder, path) = file();
        let (one, two) = (info("one", "1"), info("two", "1"));
        assert_eq!(find(&path, &one), Ok(None));
        let mut prices = Prices::GPU;
        prices.tree.step = 17.5;
        keep(&path, &one, &prices, "2026-11-22").unwrap();
        keep(&path, &two, &Prices::GPU, "2026-11-23").unwrap();
        assert_eq!(find(&path, &one), Ok(Some((prices, "2026-11-22".to_owned()))));
        assert_eq!(find(&path, &two), Ok(Some((Prices::GPU, "2026-11-23".to_owned()))));
        keep(&path, &one, &Prices::SOFTWARE, "2026-11-24").unwrap();
        assert_eq!(find(&path, &one), Ok(Some((Prices::SOFTWARE, "2026-11-24".to_owned()))));
        assert_eq!(read(&path).unwrap().unwrap().adapters.len(), 2);
    }

    #[test]
    fn another_driver_makes_prices_stale() {
        let (_folder, path) = file();
        keep(&path, &info("one", "1"), &Prices::GPU, "2026-11-22").unwrap();
        let stale = find(&path, &info("one", "2")).unwrap_err();
        assert_eq!(stale, "measured for one with the driver driver 1, but the driver is driver 2");
        assert_eq!(find(&path, &info("two", "2")), Ok(None));
    }

    #[test]
    fn damage_is_found() {
        let (_folder, path) = file();
        let one = info("one", "1");
        keep(&path, &one, &Prices::GPU, "2026-11-22").unwrap();
        let whole = std::fs::read_to_string(&path).unwrap();
        let step = whole.find("\"step\"").unwrap();
        let negative = format!("{}\"step\": -{}", &whole[..step], &whole[step + 8..]);
        let huge = "x".repeat(2 << 20);
        for (text, what) in [
            ("", "damaged: "),
            (&whole[..whole.len() / 2], "damaged: "),
            (&whole.replace("\"step\"", "\"stop\""), "damaged: missing field `step`"),
            (&negative, "damaged: a price is not a number of nanoseconds"),
            (&whole.replace("\"version\": 1", "\"version\": 2"), "written by another version"),
            (&huge, "damaged: it is larger"),
        ] {
            std::fs::write(&path, text).unwrap();
            let found = find(&path, &one).unwrap_err();
            assert!(found.starts_with(what), "{found}");
        }
        // It is replaced.
        keep(&path, &one, &Prices::GPU, "2026-11-22").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), whole);
    }

    #[test]
    fn a_folder_in_place_of_the_file_is_an_error_in_words() {
        let (_folder, path) = file();
        std::fs::create_dir_all(&path).unwrap();
        let one = info("one", "1");
        assert!(find(&path, &one).unwrap_err().starts_with("cannot be read: "));
        assert!(keep(&path, &one, &Prices::GPU, "2026-11-22").is_err());
    }

    #[test]
    fn dates() {
        for (days, date) in [
            (0, "1970-01-01"),
            (58, "1970-02-28"),
            (59, "1970-03-01"),
            (10_957, "2000-01-01"),
            (11_016, "2000-02-29"),
            (20_779, "2026-11-22"),
            (20_818, "2026-12-31"),
            (20_819, "2027-01-01"),
        ] {
            assert_eq!(day_of(days), date);
        }
    }
}
