//! Reads the triangles of a glTF 2.0 file (`.glb`, `.gltf`) into a [`SceneModel`].
//!
//! Only what casts a shadow is read: node transforms (in f64), triangle lists, strips and fans with indices of any
//! width or none, and the alpha of `MASK` materials. Points, lines, skins, morph targets, animations, colours and blend
//! transparency are passed over; a `BLEND` material is solid. Every size and index of the file is checked: a bad file
//! is an error, never a panic.

use std::fmt;
use std::path::{Path, PathBuf};

use glam::{DMat4, DQuat, DVec2, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::{Mode, Semantic};

use super::scene::{Cutout, SOLID, SceneModel};

mod bytes;

use bytes::{Buffers, Problem, split_container};

/// Why a scene file could not be read; its text is one line that names the file and what is legal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it, and what would be legal.
    pub problem: String,
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A validator's text may hold line breaks; the promise is one line.
        let problem = self.problem.split_whitespace().collect::<Vec<_>>().join(" ");
        write!(f, "{}: {problem}", self.path.display())
    }
}

impl std::error::Error for LoadError {}

/// Reads a scene from a `.glb` or `.gltf` file, whichever its first bytes say.
///
/// Buffers and images beside the file and in `data:` URIs are read too. One object per node with a mesh.
///
/// # Errors
/// [`LoadError`] for a file that is missing, truncated, not glTF 2.0, asks for an extension this reader lacks, refers
/// to what it does not hold, has positions that are not finite, or has no triangle at all.
pub fn load(path: &Path) -> Result<SceneModel, LoadError> {
    let fail = |problem: Problem| LoadError { path: path.to_owned(), problem: problem.0 };
    let content = std::fs::read(path)
        .map_err(|error| fail(Problem(format!("cannot be read ({error}); expected a .glb or .gltf file"))))?;
    let mut scene = parse(&content, path.parent()).map_err(fail)?;
    scene.name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(scene)
}

/// Reads a scene from a file's content; `folder` is where its relative URIs start.
fn parse(content: &[u8], folder: Option<&Path>) -> Result<SceneModel, Problem> {
    // Split the container, parse and validate the document.
    let (json, blob) = split_container(content)?;
    let root = gltf::json::deserialize::from_slice(json)
        .map_err(|error| Problem(format!("not glTF ({error}); expected glTF 2.0 JSON")))?;
    check_gaps(&root)?;
    let document =
        gltf::Document::from_json(root).map_err(|error| Problem(format!("invalid glTF 2.0 document: {error}")))?;
    // Read what it refers to.
    let buffers = Buffers::read(&document, blob, folder)?;
    let mut builder = Builder { buffers, folder, scene: SceneModel::default(), material_cutouts: Vec::new() };
    // Visit the nodes of the default scene, or of the first one, or every root.
    for (node, world_from_node) in world_nodes(&document)? {
        builder.add_node(&node, world_from_node)?;
    }
    builder.finish()
}

/// Checks what the validator of `gltf` 1.4 leaves to chance: with these it, or the document's iterators, would panic.
fn check_gaps(root: &gltf::json::Root) -> Result<(), Problem> {
    // A primitive's positions must exist before the validator looks at their bounds.
    let position = gltf::json::validation::Checked::Valid(Semantic::Positions);
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut accessors = primitives.filter_map(|primitive| primitive.attributes.get(&position));
    if let Some(bad) = accessors.find(|accessor| accessor.value() >= root.accessors.len()) {
        return Err(Problem(format!("accessor {} is missing; legal is 0..{}", bad.value(), root.accessors.len())));
    }
    // An image must have a source.
    let has_source = |image: &gltf::json::Image| match image.buffer_view {
        Some(_) => image.mime_type.is_some(),
        None => image.uri.is_some(),
    };
    match root.images.iter().position(|image| !has_source(image)) {
        Some(bad) => Err(Problem(format!("image {bad} has no source; legal are a uri, or a bufferView with mimeType"))),
        None => Ok(()),
    }
}

/// Lists the nodes that are drawn, each with its transform; a node with two parents or in a cycle is an error.
fn world_nodes(document: &gltf::Document) -> Result<Vec<(gltf::Node<'_>, DMat4)>, Problem> {
    let mut stack: Vec<(gltf::Node<'_>, DMat4)> = match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect(),
        None => roots(document).into_iter().map(|node| (node, DMat4::IDENTITY)).collect(),
    };
    stack.reverse();
    let mut seen = vec![false; document.nodes().len()];
    let mut nodes = Vec::with_capacity(seen.len());
    while let Some((node, world_from_parent)) = stack.pop() {
        let twice = seen.get_mut(node.index()).is_none_or(|seen| std::mem::replace(seen, true));
        if twice {
            return Err(Problem(format!("node {} is reached twice; nodes must form trees", node.index())));
        }
        let world_from_node = world_from_parent * parent_from_node(&node);
        let first_child = stack.len();
        stack.extend(node.children().map(|child| (child, world_from_node)));
        stack[first_child..].reverse();
        nodes.push((node, world_from_node));
    }
    Ok(nodes)
}

/// The nodes that are nobody's child.
fn roots(document: &gltf::Document) -> Vec<gltf::Node<'_>> {
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|node| node.children().collect::<Vec<_>>()) {
        if let Some(flag) = is_child.get_mut(child.index()) {
            *flag = true;
        }
    }
    document.nodes().filter(|node| !is_child[node.index()]).collect()
}

/// A node's own transform, composed in f64.
fn parent_from_node(node: &gltf::Node<'_>) -> DMat4 {
    match node.transform() {
        gltf::scene::Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        gltf::scene::Transform::Decomposed { translation, rotation, scale } => {
            // A file's quaternion is a unit one only to f32: restore it, so that no shear creeps in.
            let rotation = DQuat::from_array(rotation.map(f64::from));
            let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
            let [scale, translation] = [scale, translation].map(|v| DVec3::from_array(v.map(f64::from)));
            DMat4::from_scale_rotation_translation(scale, rotation, translation)
        }
    }
}

/// A scene in the making.
struct Builder<'d> {
    buffers: Buffers,
    folder: Option<&'d Path>,
    scene: SceneModel,
    /// What is already known of materials, by index.
    material_cutouts: Vec<(usize, Mask)>,
}

/// How a material lets light through.
#[derive(Clone, Copy, PartialEq)]
enum Mask {
    /// Not at all.
    Solid,
    /// By the cut-out of this index.
    Cutout(u32),
    /// Everywhere: its constant alpha is below its cutoff.
    Hole,
}

impl Builder<'_> {
    /// Adds the triangles of a node's mesh as one object.
    fn add_node(&mut self, node: &gltf::Node<'_>, world_from_node: DMat4) -> Result<(), Problem> {
        let Some(mesh) = node.mesh() else { return Ok(()) };
        let first = self.scene.triangles.len();
        for primitive in mesh.primitives() {
            self.add_primitive(&primitive, world_from_node)
                .map_err(|problem| problem.within(&format!("mesh {} primitive {}", mesh.index(), primitive.index())))?;
        }
        let object = first..self.scene.triangles.len();
        if !object.is_empty() {
            self.scene.objects.push(object);
        }
        Ok(())
    }

    /// Adds the triangles of one primitive; points and lines cast no shadow.
    fn add_primitive(&mut self, primitive: &gltf::Primitive<'_>, world_from_node: DMat4) -> Result<(), Problem> {
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let mask = self.mask(&primitive.material())?;
        if mask == Mask::Hole {
            return Ok(());
        }
        let (base, count) = self.add_positions(primitive, world_from_node)?;
        self.add_uvs(primitive, mask, count as usize)?;
        // Read indices and turn strips and fans into lists.
        let indices = match primitive.indices() {
            Some(accessor) => self.buffers.read_indices(&accessor)?,
            None => (0..count).collect(),
        };
        if let Some(index) = indices.iter().find(|&&index| index >= count) {
            return Err(Problem(format!("index {index} is out of range; legal is 0..{count}")));
        }
        // Mirrored nodes turn the winding round; turn it back.
        let mirrored = world_from_node.determinant() < 0.0;
        let cutout = if let Mask::Cutout(index) = mask { index } else { SOLID };
        for [a, b, c] in triangle_list(primitive.mode(), &indices) {
            let triangle = if mirrored { [a, c, b] } else { [a, b, c] };
            self.scene.triangles.push(triangle.map(|index| base + index));
            self.scene.triangle_cutout.push(cutout);
        }
        Ok(())
    }

    /// Adds a primitive's positions in world space; returns the first one's index and their number.
    fn add_positions(
        &mut self,
        primitive: &gltf::Primitive<'_>,
        world_from_node: DMat4,
    ) -> Result<(u32, u32), Problem> {
        let accessor = primitive.get(&Semantic::Positions).ok_or_else(|| Problem("has no POSITION".into()))?;
        let local = self.buffers.read_points(&accessor, Dimensions::Vec3)?;
        let first = self.scene.positions.len();
        let [Ok(base), Ok(_)] = [first, first + local.len()].map(u32::try_from) else {
            return Err(Problem("is one too many: more than 2^32 - 1 vertices; legal are fewer".into()));
        };
        for &[x, y, z] in &local {
            let point = world_from_node.transform_point3(DVec3::new(x, y, z));
            if !point.is_finite() {
                return Err(Problem(format!("position {point} in world space is not finite")));
            }
            self.scene.positions.push(point);
        }
        // The sum fits, so the number does.
        Ok((base, u32::try_from(local.len()).unwrap_or_default()))
    }

    /// Adds one texture coordinate per position: the mask's, or zero for solid parts.
    fn add_uvs(&mut self, primitive: &gltf::Primitive<'_>, mask: Mask, count: usize) -> Result<(), Problem> {
        let mut uvs = Vec::new();
        if let (Mask::Cutout(_), Some(info)) =
            (mask, primitive.material().pbr_metallic_roughness().base_color_texture())
        {
            let set = info.tex_coord();
            let accessor = primitive.get(&Semantic::TexCoords(set));
            let accessor = accessor.ok_or_else(|| Problem(format!("has a MASK texture but no TEXCOORD_{set}")))?;
            uvs = self.buffers.read_points(&accessor, Dimensions::Vec2)?;
            if uvs.len() != count {
                return Err(Problem(format!("TEXCOORD_{set} has {} entries; legal is {count}", uvs.len())));
            }
        }
        self.scene.uvs.extend(uvs.iter().map(|&[u, v, _]| DVec2::new(u, v)));
        self.scene.uvs.resize(self.scene.positions.len(), DVec2::ZERO);
        Ok(())
    }

    /// Finds how a material lets light through, reading its alpha image once.
    fn mask(&mut self, material: &gltf::Material<'_>) -> Result<Mask, Problem> {
        let Some(index) = material.index() else { return Ok(Mask::Solid) };
        if material.alpha_mode() != gltf::material::AlphaMode::Mask {
            return Ok(Mask::Solid);
        }
        if let Some(&(_, known)) = self.material_cutouts.iter().find(|known| known.0 == index) {
            return Ok(known);
        }
        let mask = self.read_mask(material).map_err(|problem| problem.within(&format!("material {index}")))?;
        self.material_cutouts.push((index, mask));
        Ok(mask)
    }

    /// Reads the alpha of a `MASK` material: base colour texture times base colour factor.
    fn read_mask(&mut self, material: &gltf::Material<'_>) -> Result<Mask, Problem> {
        let cutoff = material.alpha_cutoff().unwrap_or(DEFAULT_CUTOFF);
        let base_color = material.pbr_metallic_roughness();
        let factor = base_color.base_color_factor()[3];
        // Alpha cannot leave 0..=1, so some pairs decide without the texture.
        if cutoff <= 0.0 {
            return Ok(Mask::Solid);
        }
        if factor < cutoff {
            return Ok(Mask::Hole);
        }
        let Some(info) = base_color.base_color_texture() else { return Ok(Mask::Solid) };
        // alpha * factor >= cutoff is alpha >= cutoff / factor.
        let image = self.buffers.read_image(&info.texture().source(), self.folder)?;
        let (width, height) = image.dimensions();
        let alpha = image.pixels().map(|pixel| pixel.0[3]).collect();
        let index = u32::try_from(self.scene.cutouts.len()).map_err(|_| Problem("is one mask too many".into()))?;
        self.scene.cutouts.push(Cutout { width, height, alpha, cutoff: cutoff / factor });
        Ok(Mask::Cutout(index))
    }

    /// Drops what a scene without cut-outs does not need.
    fn finish(mut self) -> Result<SceneModel, Problem> {
        if self.scene.triangles.is_empty() {
            return Err(Problem("holds no triangles; expected at least one in its default scene".into()));
        }
        if self.scene.cutouts.is_empty() {
            self.scene.uvs.clear();
            self.scene.triangle_cutout.clear();
        }
        Ok(self.scene)
    }
}

/// The cutoff of a `MASK` material that states none (glTF 2.0, section 3.9.4).
const DEFAULT_CUTOFF: f32 = 0.5;

/// Turns a primitive's indices into triangles; what is left over at the end is not drawn (glTF 2.0, section 3.7.2.1).
fn triangle_list(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let windows = indices.windows(3).enumerate();
            windows.map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }).collect()
        }
        Mode::TriangleFan => indices.windows(2).skip(1).map(|w| [indices[0], w[0], w[1]]).collect(),
        _ => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}

/// Bytes of one component.
fn component_size(data_type: DataType) -> usize {
    match data_type {
        DataType::I8 | DataType::U8 => 1,
        DataType::I16 | DataType::U16 => 2,
        DataType::U32 | DataType::F32 => 4,
    }
}

#[cfg(test)]
mod tests;
