//! Finds files of a crate that import each other in circles. A file imports another if a `use` or a path names an item
//! of the other file. If a name passes through `pub use`, the file that defines it counts. A door is a `pub use` of a
//! name that its own file does not need. It is not an import.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use quote::ToTokens;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree};

use super::sources::{ROOT, sources};

/// Segments of the path of a module below the root of its crate.
type Module = Vec<String>;

/// The names in a file.
#[derive(Default)]
struct Names {
    /// Imports: whether it is public, the name in this file, and the path.
    uses: Vec<(bool, String, Vec<String>)>,
    /// The paths in the code, and the first segments of all paths.
    paths: Vec<Vec<String>>,
    words: BTreeSet<String>,
    /// Modules that are compiled only for tests.
    test_modules: BTreeSet<String>,
}

impl Names {
    fn import(&mut self, is_public: bool, tree: &UseTree, mut path: Vec<String>) {
        match tree {
            UseTree::Path(part) => {
                path.push(part.ident.to_string());
                self.import(is_public, &part.tree, path);
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.import(is_public, tree, path.clone());
                }
            }
            UseTree::Glob(_) => self.uses.push((is_public, "*".to_owned(), path)),
            UseTree::Name(name) => {
                let name = name.ident.to_string();
                if name != "self" {
                    path.push(name);
                }
                let name = path.last().cloned().unwrap_or_default();
                self.uses.push((is_public, name, path));
            }
            UseTree::Rename(rename) => {
                if rename.ident != "self" {
                    path.push(rename.ident.to_string());
                }
                self.uses.push((is_public, rename.rename.to_string(), path));
            }
        }
    }
}

/// Whether code is compiled only for tests.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let words = attribute.meta.to_token_stream().to_string();
        attribute.path().is_ident("cfg") && ["(test)", "(all (test ,"].iter().any(|t| words.contains(t))
    })
}

impl<'a> Visit<'a> for Names {
    fn visit_item(&mut self, item: &'a Item) {
        match item {
            Item::Use(one) => {
                let is_public = !matches!(one.vis, syn::Visibility::Inherited);
                self.import(is_public, &one.tree, Vec::new());
            }
            Item::Mod(module) if is_for_tests(&module.attrs) => {
                self.test_modules.insert(module.ident.to_string());
            }
            _ => visit::visit_item(self, item),
        }
    }

    /// The path in `pub(crate)` names no code.
    fn visit_visibility(&mut self, _: &'a syn::Visibility) {}

    fn visit_path(&mut self, path: &'a syn::Path) {
        let segments: Vec<String> = path.segments.iter().map(|one| one.ident.to_string()).collect();
        self.words.extend(segments.first().cloned());
        if segments.len() > 1 {
            self.paths.push(segments);
        }
        visit::visit_path(self, path);
    }
}

/// The files of a crate.
struct Crate {
    files: BTreeMap<Module, Names>,
}

impl Crate {
    fn read(folder: &str) -> Self {
        let root = Path::new(ROOT).join(folder);
        let mut files = BTreeMap::new();
        for (path, text) in sources(folder) {
            let path = path.strip_prefix(&root).unwrap().with_extension("");
            let mut module: Module = path.iter().map(|part| part.to_str().unwrap().to_owned()).collect();
            let is_root = module == ["lib"] || module == ["main"];
            if is_root || module.last().is_some_and(|last| last == "mod") {
                module.pop();
            }
            let mut names = Names::default();
            names.visit_file(&syn::parse_file(&text).unwrap());
            // If there is a `lib.rs`, `main.rs` is a separate crate that no file imports.
            if !is_root || path.ends_with("lib") || !files.contains_key(&module) {
                files.insert(module, names);
            }
        }
        let tests: Vec<Module> = files
            .iter()
            .flat_map(|(module, names)| names.test_modules.iter().map(move |name| (module, name)))
            .map(|(module, name)| module.iter().chain([name]).cloned().collect())
            .collect();
        files.retain(|module, _| !tests.iter().any(|test| module.starts_with(test)));
        Self { files }
    }

    /// Converts a path in a file to a path from the root of the crate; `None` if it leads to another crate.
    fn absolute(&self, file: &Module, path: &[String]) -> Option<Vec<String>> {
        let first = path.first()?;
        let mut base = file.clone();
        let rest = match first.as_str() {
            "crate" => {
                base.clear();
                &path[1..]
            }
            "self" => &path[1..],
            "super" => {
                let up = path.iter().take_while(|part| *part == "super").count();
                base.truncate(base.len().checked_sub(up)?);
                &path[up..]
            }
            _ => {
                let is_child = self.files.contains_key(&[&base[..], &path[..1]].concat());
                return is_child.then(|| [&base[..], path].concat());
            }
        };
        Some([&base[..], rest].concat())
    }

    /// Returns the file that defines the item with an absolute path.
    fn definition(&self, path: &[String], depth: usize) -> Option<Module> {
        let longest = (0..=path.len()).rev().find(|n| self.files.contains_key(&path[..*n]))?;
        let (module, rest) = path.split_at(longest);
        let module = module.to_vec();
        if let Some(name) = rest.first().filter(|_| depth < 16) {
            let passed_on = self.files[&module].uses.iter().find(|(_, alias, _)| alias == name);
            if let Some((_, _, source)) = passed_on {
                let source = [&self.absolute(&module, source)?, &rest[1..]].concat();
                return self.definition(&source, depth + 1);
            }
        }
        Some(module)
    }

    /// Returns the files that a file imports.
    fn imports(&self, file: &Module) -> BTreeSet<Module> {
        let names = &self.files[file];
        let used = names.uses.iter().filter(|(is_public, name, _)| !is_public || names.words.contains(name));
        let paths = used.map(|(_, _, path)| path).chain(&names.paths);
        let absolute = paths.filter_map(|path| self.absolute(file, path));
        let found = absolute.filter_map(|path| self.definition(&path, 0));
        found.filter(|module| module != file).collect()
    }

    /// Returns the files that import themselves through others, with their imports from the same circle.
    fn circles(&self) -> BTreeMap<Module, BTreeSet<Module>> {
        let imports: BTreeMap<&Module, BTreeSet<Module>> =
            self.files.keys().map(|file| (file, self.imports(file))).collect();
        let mut reached: BTreeMap<&Module, BTreeSet<&Module>> = BTreeMap::new();
        for file in self.files.keys() {
            let (of_file, mut next) = (reached.entry(file).or_default(), vec![file]);
            while let Some(file) = next.pop() {
                next.extend(imports[file].iter().filter(|import| of_file.insert(*import)));
            }
        }
        let circle = |(file, imports): (&&Module, &BTreeSet<Module>)| {
            let inside = imports.iter().filter(|other| reached[other].contains(*file));
            ((*file).clone(), inside.cloned().collect::<BTreeSet<Module>>())
        };
        imports.iter().map(circle).filter(|(_, imports)| !imports.is_empty()).collect()
    }
}

/// Returns the number of files of a crate that import each other in circles, and a list of these imports.
pub(crate) fn circles(folder: &str) -> (usize, String) {
    let circles = Crate::read(folder).circles();
    let name = |module: &Module| match module.join("/") {
        name if name.is_empty() => "the root".to_owned(),
        name => name,
    };
    let line = |(file, imports): (&Module, &BTreeSet<Module>)| {
        let imports: Vec<String> = imports.iter().map(name).collect();
        format!("  {} imports {}\n", name(file), imports.join(", "))
    };
    (circles.len(), circles.iter().map(line).collect())
}

/// The search itself: it reads `super`, follows `pub use`, and ignores tests and doors.
#[test]
fn circles_are_found() {
    let names = |text: &str| {
        let mut names = Names::default();
        names.visit_file(&syn::parse_file(text).unwrap());
        names
    };
    let of = |files: &[(&str, &str)]| {
        let module =
            |path: &str| -> Module { path.split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect() };
        let files = files.iter().map(|(path, text)| (module(path), names(text))).collect();
        Crate { files }.circles().into_keys().map(|file| file.join("/")).collect::<Vec<_>>()
    };
    let door = ("", "mod a; mod b; pub use a::A;");
    assert!(of(&[door, ("a", "pub struct A;"), ("b", "use crate::A;")]).is_empty());
    let circle = [("a", "use super::b::B; pub struct A;"), ("b", "use crate::A; pub struct B;")];
    assert_eq!(of(&[door, circle[0], circle[1]]), ["a", "b"]);
    let needed = ("", "mod a; pub use a::A; pub struct Of(A);");
    assert_eq!(of(&[needed, ("a", "pub struct A; fn f(_: super::Of) {}")]), ["", "a"]);
    let in_tests = ("b", "pub struct B; #[cfg(test)] mod tests { use crate::a::A; }");
    assert!(of(&[door, circle[0], in_tests]).is_empty());
}
