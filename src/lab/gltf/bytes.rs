//! The bytes of a glTF file: container, buffers, accessors, images; every offset checked.

use std::path::Path;

use base64::Engine as _;
use gltf::Document;
use gltf::accessor::{Accessor, DataType, Dimensions};
use gltf::buffer::Source as BufferSource;
use gltf::image::Source as ImageSource;

use super::component_size;

/// What is wrong with a file, and what would be legal.
#[derive(Debug)]
pub(super) struct Problem(pub(super) String);

impl Problem {
    /// Says where in the document the problem is.
    pub(super) fn within(self, place: &str) -> Self {
        Self(format!("{place}: {}", self.0))
    }
}

const MAGIC: &[u8] = b"glTF";
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;
const JSON_CHUNK: &[u8] = b"JSON";
const BINARY_CHUNK: &[u8] = b"BIN\0";

/// Splits a binary glTF file into its JSON and binary chunks; anything else is taken for JSON as a whole.
pub(super) fn split_container(content: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    if !content.starts_with(MAGIC) {
        return Ok((content, None));
    }
    // Check version and total length.
    let header = [read_u32(content, 4), read_u32(content, 8)];
    let [Some(version), Some(length)] = header else {
        return Err(Problem(format!("truncated: {} bytes; a .glb header has {HEADER_BYTES}", content.len())));
    };
    if version != 2 {
        return Err(Problem(format!("binary glTF version {version}; legal is 2")));
    }
    let length = length as usize;
    if length < HEADER_BYTES || length > content.len() {
        let got = content.len();
        return Err(Problem(format!("truncated: {got} bytes where the header says {length}; expected all of them")));
    }
    // Take the first chunk and, if there is one, the second; later chunks are extensions to be ignored.
    let (kind, json, rest) = split_chunk(&content[HEADER_BYTES..length])?;
    if kind != JSON_CHUNK {
        return Err(Problem("the first chunk is not JSON, as it must be".into()));
    }
    if rest.is_empty() {
        return Ok((json, None));
    }
    let (kind, binary, _) = split_chunk(rest)?;
    Ok((json, (kind == BINARY_CHUNK).then_some(binary)))
}

/// A chunk's kind and data, and the bytes after it.
type Chunk<'c> = (&'c [u8], &'c [u8], &'c [u8]);

/// Splits kind and data of the first chunk from the rest.
fn split_chunk(bytes: &[u8]) -> Result<Chunk<'_>, Problem> {
    let truncated = || Problem("truncated: a chunk ends before its length; expected the whole chunk".into());
    let length = read_u32(bytes, 0).ok_or_else(truncated)? as usize;
    let data = bytes.get(CHUNK_HEADER_BYTES..).ok_or_else(truncated)?;
    let (data, rest) = data.split_at_checked(length).ok_or_else(truncated)?;
    Ok((&bytes[4..CHUNK_HEADER_BYTES], data, rest))
}

fn read_u32(bytes: &[u8], offset: usize) -> Option<u32> {
    let bytes = bytes.get(offset..)?.first_chunk()?;
    Some(u32::from_le_bytes(*bytes))
}

/// The buffers of a document, in its order.
pub(super) struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    /// Reads every buffer: the binary chunk, `data:` URIs and files beside the document.
    pub(super) fn read(document: &Document, blob: Option<&[u8]>, folder: Option<&Path>) -> Result<Self, Problem> {
        let read = |buffer: gltf::Buffer<'_>| {
            let index = buffer.index();
            let data = match buffer.source() {
                BufferSource::Bin => {
                    let blob =
                        blob.ok_or_else(|| Problem(format!("buffer {index} needs a BIN chunk; there is none")))?;
                    blob.to_vec()
                }
                BufferSource::Uri(uri) => {
                    read_uri(uri, folder).map_err(|problem| problem.within(&format!("buffer {index}")))?
                }
            };
            if data.len() < buffer.length() {
                let (got, expected) = (data.len(), buffer.length());
                return Err(Problem(format!("buffer {index} has {got} bytes; expected {expected}")));
            }
            Ok(data)
        };
        document.buffers().map(read).collect::<Result<_, _>>().map(Self)
    }

    /// Reads vectors of 2 or 3 components as f64 (missing components are 0); they must be finite.
    pub(super) fn read_points(&self, accessor: &Accessor<'_>, shape: Dimensions) -> Result<Vec<[f64; 3]>, Problem> {
        if accessor.dimensions() != shape {
            return Err(accessor_problem(
                accessor,
                &format!("has shape {:?}; legal is {shape:?}", accessor.dimensions()),
            ));
        }
        let components = shape.multiplicity();
        let element = |bytes: &[u8]| {
            let mut point = [0.0; 3];
            for (value, bytes) in point[..components].iter_mut().zip(bytes.chunks(bytes.len() / components)) {
                *value = component(bytes, accessor.data_type(), accessor.normalized());
            }
            point
        };
        let points = self.read_elements(accessor, components, element, [0.0; 3])?;
        match points.iter().find(|point| point.iter().any(|value| !value.is_finite())) {
            Some(bad) => Err(accessor_problem(accessor, &format!("holds {bad:?}; every component must be finite"))),
            None => Ok(points),
        }
    }

    /// Reads indices of 8, 16 or 32 bits.
    pub(super) fn read_indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, Problem> {
        let legal = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
        if !legal || accessor.dimensions() != Dimensions::Scalar {
            return Err(accessor_problem(accessor, "holds no indices; legal are scalars of type u8, u16, u32"));
        }
        self.read_elements(accessor, 1, index, 0)
    }

    /// Reads an accessor's elements and then its sparse replacements.
    fn read_elements<T: Copy>(
        &self,
        accessor: &Accessor<'_>,
        components: usize,
        element: impl Fn(&[u8]) -> T,
        zero: T,
    ) -> Result<Vec<T>, Problem> {
        let size = components * component_size(accessor.data_type());
        let count = accessor.count();
        let outside = || accessor_problem(accessor, "reaches past the end of its buffer; it must lie inside");
        let mut elements = match accessor.view() {
            Some(view) => {
                let places = self.elements(&view, accessor.offset(), size, count).ok_or_else(outside)?;
                places.map(&element).collect()
            }
            // Without a view every element is zero; a file of a few bytes must not ask for gigabytes.
            None if count > MAX_VIEWLESS => return Err(outside()),
            None => vec![zero; count],
        };
        if let Some(sparse) = accessor.sparse() {
            let (indices, values) = (sparse.indices(), sparse.values());
            let index_size = match indices.index_type() {
                gltf::accessor::sparse::IndexType::U8 => 1,
                gltf::accessor::sparse::IndexType::U16 => 2,
                gltf::accessor::sparse::IndexType::U32 => 4,
            };
            let places = self.elements(&indices.view(), indices.offset(), index_size, sparse.count());
            let values = self.elements(&values.view(), values.offset(), size, sparse.count());
            for (place, value) in places.ok_or_else(outside)?.zip(values.ok_or_else(outside)?) {
                *elements.get_mut(index(place) as usize).ok_or_else(outside)? = element(value);
            }
        }
        Ok(elements)
    }

    /// Returns the bytes of each element of a view; `None` when any lies outside.
    fn elements(
        &self,
        view: &gltf::buffer::View<'_>,
        offset: usize,
        size: usize,
        count: usize,
    ) -> Option<impl Iterator<Item = &[u8]> + use<'_>> {
        let bytes = self.view(view)?.get(offset..)?;
        let stride = view.stride().unwrap_or(size);
        let needed = match count {
            0 => 0,
            _ => stride.checked_mul(count - 1)?.checked_add(size)?,
        };
        let bytes = bytes.get(..needed)?;
        Some((0..count).map(move |i| &bytes[i * stride..i * stride + size]))
    }

    fn view(&self, view: &gltf::buffer::View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.0.get(view.buffer().index())?.get(view.offset()..end)
    }

    /// Reads and decodes an image (PNG or JPEG).
    pub(super) fn read_image(
        &self,
        image: &gltf::Image<'_>,
        folder: Option<&Path>,
    ) -> Result<image::RgbaImage, Problem> {
        let place = format!("image {}", image.index());
        let owned;
        let encoded = match image.source() {
            ImageSource::View { view, .. } => {
                self.view(&view).ok_or_else(|| Problem(format!("{place} lies outside its buffer")))?
            }
            ImageSource::Uri { uri, .. } => {
                owned = read_uri(uri, folder).map_err(|problem| problem.within(&place))?;
                &owned
            }
        };
        let decoded = image::load_from_memory(encoded)
            .map_err(|error| Problem(format!("{place} cannot be decoded ({error}); legal are PNG and JPEG")))?;
        Ok(decoded.into_rgba8())
    }
}

/// Elements an accessor without a buffer view may claim: 2²⁴ zeros, far above any real use.
const MAX_VIEWLESS: usize = 1 << 24;

fn accessor_problem(accessor: &Accessor<'_>, problem: &str) -> Problem {
    Problem(format!("accessor {} {problem}", accessor.index()))
}

/// Widens a little-endian unsigned integer of 1, 2 or 4 bytes.
fn index(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))
}

/// Widens one component; normalised integers become -1..=1 or 0..=1 (glTF 2.0, section 3.6.2.2).
fn component(bytes: &[u8], data_type: DataType, normalized: bool) -> f64 {
    let raw = index(bytes);
    let (value, scale) = match data_type {
        DataType::F32 => return f64::from(f32::from_bits(raw)),
        DataType::U32 => (f64::from(raw), f64::from(u32::MAX)),
        DataType::U16 => (f64::from(raw), f64::from(u16::MAX)),
        DataType::U8 => (f64::from(raw), f64::from(u8::MAX)),
        DataType::I16 => (signed(raw, 16), f64::from(i16::MAX)),
        DataType::I8 => (signed(raw, 8), f64::from(i8::MAX)),
    };
    if normalized { (value / scale).max(-1.0) } else { value }
}

/// Reads the low bits of a number as two's complement.
fn signed(raw: u32, bits: u32) -> f64 {
    let unused = u32::BITS - bits;
    f64::from((raw << unused).cast_signed() >> unused)
}

/// Reads what a URI names: base64 data, or a file relative to the document.
fn read_uri(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, Problem> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, base64) =
            data.split_once(";base64,").ok_or_else(|| Problem("data URI is not base64, as it must be".into()))?;
        return base64::engine::general_purpose::STANDARD
            .decode(base64)
            .map_err(|error| Problem(format!("data URI cannot be decoded ({error}); expected base64")));
    }
    let (Some(folder), false) = (folder, uri.contains(':')) else {
        return Err(Problem(format!("URI \"{uri}\" cannot be read; legal are data: URIs and relative paths")));
    };
    let name = percent_decode(uri).ok_or_else(|| Problem(format!("URI \"{uri}\" is not percent-encoded UTF-8")))?;
    std::fs::read(folder.join(&name))
        .map_err(|error| Problem(format!("\"{name}\" cannot be read ({error}); expected a file beside the document")))
}

/// Replaces `%20` and its like; `None` when the result is not UTF-8 or an escape is malformed.
fn percent_decode(uri: &str) -> Option<String> {
    let mut parts = uri.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        bytes.push(u8::from_str_radix(part.get(..2)?, 16).ok()?);
        bytes.extend_from_slice(&part.as_bytes()[2..]);
    }
    String::from_utf8(bytes).ok()
}
