//! The shape of the source: levels, headings, names, and the files at the top.
//! What a rule forbids is shown with its file.

use std::fs;
use std::path::{Path, PathBuf};

/// Level of each module of the library (DESIGN: a file imports only files of a lower level; of its own level only
/// within one folder).
const LEVELS: &[(&str, u8)] = &[
    ("error", 0),
    ("report", 0),
    ("math", 0),
    ("camera", 1),
    ("light", 1),
    ("scene", 1),
    ("content", 1),
    ("texel", 0),
    ("grazing", 0),
    ("key", 1),
    ("frame", 2),
    ("encoding", 3),
    ("technique", 3),
    ("light_space", 2),
    ("focus", 3),
    ("wgsl", 3),
    ("aliasing", 3),
    ("split", 4),
    ("warp", 4),
    ("fit", 5),
    ("remix", 6),
    ("techniques", 7),
    ("auto", 7),
    ("gpu", 7),
    ("transpile", 7),
    ("lab", 8),
];

/// Where the library is.
const SOURCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src");

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found
}

/// The files of the library. Those named `tests.rs` are left out, each of which the file above it has to declare as a
/// test.
fn sources() -> Vec<PathBuf> {
    let (tests, sources): (Vec<_>, Vec<_>) =
        files(Path::new(SOURCE)).into_iter().partition(|path| path.ends_with("tests.rs"));
    assert!(!tests.is_empty(), "the test looks for tests.rs");
    for path in tests {
        let folder = path.parent().expect("a folder");
        let above = [folder.with_extension("rs"), folder.join("mod.rs")].into_iter().find(|above| above.exists());
        let text = fs::read_to_string(above.expect("the file above")).expect("readable");
        let declared = text.rsplit_once("#[cfg(test)]").is_some_and(|(_, end)| end.trim_end().ends_with("mod tests;"));
        assert!(declared, "{} is more than a test", path.display());
    }
    sources
}

/// The module a source file belongs to, by its first folder or its name.
fn module(path: &Path) -> String {
    let inside = path.strip_prefix(SOURCE).expect("inside src");
    let first = inside.components().next().expect("a name").as_os_str().to_string_lossy().into_owned();
    first.trim_end_matches(".rs").to_owned()
}

fn level(module: &str) -> u8 {
    let found = LEVELS.iter().find(|(name, _)| *name == module);
    found.unwrap_or_else(|| panic!("src/{module} has no level: add it to LEVELS where DESIGN puts it")).1
}

/// The code of a file without its tests.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("readable");
    text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default().to_owned()
}

#[test]
fn files_import_lower_levels_only() {
    let mut imports = 0;
    for path in sources() {
        let own = module(&path);
        if own == "lib" {
            continue;
        }
        for line in code(&path).lines().filter(|line| !line.trim_start().starts_with("//")) {
            let Some(rest) = line.split("crate::").nth(1) else { continue };
            let other: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if other.is_empty() || other == own || other.chars().next().is_some_and(char::is_uppercase) {
                continue;
            }
            imports += 1;
            assert!(
                level(&other) < level(&own),
                "{}: level {} imports {other}, level {}",
                path.display(),
                level(&own),
                level(&other)
            );
        }
    }
    assert!(imports > 30, "the test reads imports: {imports}");
}

#[test]
fn methods_name_their_references() {
    for folder in ["split", "warp", "encoding"] {
        let folder = Path::new(SOURCE).join(folder);
        if !folder.exists() {
            continue;
        }
        for path in sources().into_iter().filter(|path| path.starts_with(&folder) && !path.ends_with("mod.rs")) {
            let text = fs::read_to_string(&path).expect("readable");
            assert!(text.contains("//! # References"), "{} names no references", path.display());
        }
    }
}

#[test]
fn matrices_are_named_to_from() {
    for path in sources() {
        for (number, line) in code(&path).lines().enumerate() {
            for kind in [": Mat4", ": DMat4", ": &Mat4", ": &DMat4"] {
                let Some(before) = line.split(kind).next().filter(|before| before.len() < line.len()) else { continue };
                let name: String = before
                    .chars()
                    .rev()
                    .take_while(|c| c.is_alphanumeric() || *c == '_')
                    .collect::<String>()
                    .chars()
                    .rev()
                    .collect();
                assert!(
                    name.contains("_from_") || name == "to_from" || name == "ndc",
                    "{}:{}: matrix `{name}` is not named to_from",
                    path.display(),
                    number + 1
                );
            }
        }
    }
}

#[test]
fn nothing_is_left_undone() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["src", "examples", "benches", "tests"] {
        for path in files(&root.join(folder)) {
            if path.ends_with("source.rs") {
                continue;
            }
            let text = fs::read_to_string(&path).expect("readable");
            // What must not stand in the code: these are the words that are looked for.
            for word in ["todo!(", "unimplemented!(", "dbg!(", "#[ignore", "unsafe {"] {
                assert!(!text.contains(word), "{} contains {word}", path.display());
            }
        }
    }
}

#[test]
fn the_core_stays_small_and_free_of_the_gpu() {
    for path in sources() {
        if matches!(module(&path).as_str(), "gpu" | "lab" | "transpile") {
            continue;
        }
        let code = code(&path);
        assert!(!code.contains("wgpu::") && !code.contains("naga::"), "{} names a GPU crate", path.display());
        assert!(!code.contains(".unwrap()") && !code.contains("panic!("), "{} can panic", path.display());
    }
    let remix = fs::read_to_string(Path::new(SOURCE).join("remix.rs")).expect("readable");
    assert!(remix.lines().count() <= 150, "remix.rs reads as an outline of at most 150 lines");
}
