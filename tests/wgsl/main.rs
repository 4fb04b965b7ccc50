//! The shader contract: what every text of the library promises to the engines that paste it into theirs.

mod cost;
mod engines;
mod host;
#[path = "../common/keys.rs"]
mod keys;
mod text;
mod walkers;

use antumbra::transpile::Shader;
use antumbra::{WgslKey, wgsl};

/// Keys that cover every choice, each with its library: the fragments, without bindings.
fn libraries() -> impl Iterator<Item = (WgslKey, String, Shader)> {
    keys::covering().map(|key| {
        let (text, shader) = library(key);
        (key, text, shader)
    })
}

/// The library of a key: the fragments, without bindings.
fn library(key: WgslKey) -> (String, Shader) {
    let text = wgsl::library(key).join("\n");
    let shader = Shader::parse(&text).unwrap_or_else(|error| panic!("{key:?}: {error}"));
    (text, shader)
}
