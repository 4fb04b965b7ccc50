//! Feature `naga`: WGSL checked at run time, stripped of what nobody calls, and turned into the text of other APIs.
//!
//! For engines that do not speak WGSL, and for tools. Nothing here is needed to use the library with wgpu.
//!
//! ```
//! use antumbra::transpile::{Glsl, Shader};
//! use antumbra::{Pcf, WgslKey, wgsl};
//!
//! let key = WgslKey { filter: Pcf::Hardware2x2, ..WgslKey::default() };
//! let host = "@fragment fn shade(@location(0) at: vec3f) -> @location(0) vec4f {
//!     return vec4f(antumbra_visibility(at, vec3f(0.0, 1.0, 0.0), 1.0));
//! }";
//! let text = wgsl::module(key, wgsl::Bindings { group: 0, first: 0 }) + host;
//! let shader = Shader::parse(&text)?.keep(&["shade"])?;
//! let metal = shader.msl()?;
//! let web = shader.glsl(Glsl::Es300, "shade")?;
//! # assert!(metal.contains("shade") && web.text.contains("sampler2DShadow"));
//! # Ok::<(), antumbra::transpile::TranspileError>(())
//! ```

use core::fmt;

pub use naga;
use naga::back;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// Shader text that was parsed and validated.
#[derive(Clone, Debug)]
pub struct Shader {
    /// naga's form of the text, for writers with options of their own.
    pub module: naga::Module,
    /// What validation found out about it.
    pub info: ModuleInfo,
}

/// What went wrong, in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TranspileError {
    /// The text is not WGSL.
    Parse {
        /// Line, from 1; 0 where it is not known.
        line: u32,
        /// What the parser says.
        message: String,
    },
    /// The text is WGSL with a rule broken.
    Validate {
        /// What the validator says, outermost cause first.
        message: String,
    },
    /// The text has no entry point of that name.
    NoEntryPoint {
        /// The name that was asked for.
        name: String,
        /// The names that there are, separated by commas.
        present: String,
    },
    /// The target language cannot express the shader.
    Write {
        /// The target language.
        target: &'static str,
        /// What its writer says, outermost cause first.
        message: String,
    },
}

impl fmt::Display for TranspileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parse { line, message } => write!(f, "line {line} is not WGSL: {message}"),
            Self::Validate { message } => write!(f, "the shader breaks a rule of WGSL: {message}"),
            Self::NoEntryPoint { name, present } => write!(f, "entry point is {name}; legal: one of [{present}]"),
            Self::Write { target, message } => write!(f, "{target} cannot express the shader: {message}"),
        }
    }
}

impl core::error::Error for TranspileError {}

/// Versions of GLSL.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Glsl {
    /// OpenGL 4.5.
    Desktop450,
    /// OpenGL ES 3.1.
    Es310,
    /// OpenGL ES 3.0 and WebGL 2.
    Es300,
}

impl Glsl {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Desktop450, Self::Es310, Self::Es300];

    fn version(self) -> back::glsl::Version {
        match self {
            Self::Desktop450 => back::glsl::Version::Desktop(450),
            Self::Es310 => back::glsl::Version::new_gles(310),
            Self::Es300 => back::glsl::Version::new_gles(300),
        }
    }
}

/// A GLSL shader, and the names by which its resources are bound: GLSL joins a texture and its sampler into one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GlslShader {
    /// The text, with `main` as its entry point.
    pub text: String,
    /// Combined samplers: name in the text, name of the WGSL texture; sorted.
    pub samplers: Vec<(String, String)>,
    /// Uniform blocks: name in the text, name of the WGSL variable; sorted.
    pub blocks: Vec<(String, String)>,
}

impl Shader {
    /// Parses and validates WGSL, a library without entry points included.
    ///
    /// # Errors
    /// The text is not valid WGSL.
    pub fn parse(text: &str) -> Result<Self, TranspileError> {
        let module = naga::front::wgsl::parse_str(text).map_err(|error| TranspileError::Parse {
            line: error.location(text).map_or(0, |at| at.line_number),
            message: error.message().to_owned(),
        })?;
        Self::validated(module)
    }

    fn validated(module: naga::Module) -> Result<Self, TranspileError> {
        let info = Validator::new(ValidationFlags::all(), Capabilities::default())
            .validate(&module)
            .map_err(|error| TranspileError::Validate { message: causes(error.as_inner()) })?;
        Ok(Self { module, info })
    }

    /// Names of the entry points.
    pub fn entry_points(&self) -> impl Iterator<Item = &str> {
        self.module.entry_points.iter().map(|entry| entry.name.as_str())
    }

    /// The shader with these entry points alone, and nothing that they do not use.
    ///
    /// # Errors
    /// An entry point that is not there.
    pub fn keep(&self, entry_points: &[&str]) -> Result<Self, TranspileError> {
        for name in entry_points {
            self.entry(name)?;
        }
        let mut module = self.module.clone();
        module.entry_points.retain(|entry| entry_points.contains(&entry.name.as_str()));
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        Self::validated(module)
    }

    /// SPIR-V 1.0 words, with the WGSL binding numbers.
    ///
    /// # Errors
    /// The shader needs something that SPIR-V 1.0 lacks.
    pub fn spirv(&self) -> Result<Vec<u32>, TranspileError> {
        back::spv::write_vec(&self.module, &self.info, &back::spv::Options::default(), None)
            .map_err(|error| not_written("SPIR-V", &error))
    }

    /// HLSL for shader model 5.1, with registers in the order of the WGSL binding numbers.
    ///
    /// # Errors
    /// The shader needs something that HLSL lacks.
    pub fn hlsl(&self) -> Result<String, TranspileError> {
        let (options, pipeline) = (back::hlsl::Options::default(), back::hlsl::PipelineOptions::default());
        let mut text = String::new();
        back::hlsl::Writer::new(&mut text, &options, &pipeline)
            .write(&self.module, &self.info, None)
            .map_err(|error| not_written("HLSL", &error))?;
        Ok(text)
    }

    /// Metal shading language. Resources have placeholder bindings:
    /// engines that need numbers write `module` themselves.
    ///
    /// # Errors
    /// The shader needs something that MSL lacks.
    pub fn msl(&self) -> Result<String, TranspileError> {
        let (options, pipeline) = (back::msl::Options::default(), back::msl::PipelineOptions::default());
        let (text, _) = back::msl::write_string(&self.module, &self.info, &options, &pipeline)
            .map_err(|error| not_written("MSL", &error))?;
        Ok(text)
    }

    /// GLSL of one entry point.
    ///
    /// # Errors
    /// An entry point that is not there, or something that GLSL lacks.
    pub fn glsl(&self, version: Glsl, entry_point: &str) -> Result<GlslShader, TranspileError> {
        // Write.
        let stage = self.entry(entry_point)?.stage;
        let options = back::glsl::Options { version: version.version(), ..Default::default() };
        let pipeline =
            back::glsl::PipelineOptions { shader_stage: stage, entry_point: entry_point.to_owned(), multiview: None };
        let (mut text, policies) = (String::new(), naga::proc::BoundsCheckPolicies::default());
        let failed = |error| not_written("GLSL", &error);
        let reflection = back::glsl::Writer::new(&mut text, &self.module, &self.info, &options, &pipeline, policies)
            .and_then(|mut writer| writer.write())
            .map_err(failed)?;
        // Say what is bound under which name.
        let name = |handle: naga::Handle<naga::GlobalVariable>| {
            self.module.global_variables[handle].name.clone().unwrap_or_default()
        };
        let mut samplers: Vec<_> =
            reflection.texture_mapping.iter().map(|(glsl, map)| (glsl.clone(), name(map.texture))).collect();
        let mut blocks: Vec<_> =
            reflection.uniforms.iter().map(|(global, glsl)| (glsl.clone(), name(*global))).collect();
        samplers.sort();
        blocks.sort();
        Ok(GlslShader { text, samplers, blocks })
    }

    /// GLSL of a library: every function that touches no global, behind an empty fragment `main`, which GLSL writers
    /// need and engines cut off.
    ///
    /// # Errors
    /// Something that GLSL lacks.
    pub fn glsl_library(&self, version: Glsl) -> Result<GlslShader, TranspileError> {
        let mut module = self.module.clone();
        module.entry_points = vec![naga::EntryPoint {
            name: STUB.to_owned(),
            stage: naga::ShaderStage::Fragment,
            early_depth_test: None,
            workgroup_size: [0; 3],
            workgroup_size_overrides: None,
            function: naga::Function { name: Some(STUB.to_owned()), ..Default::default() },
            mesh_info: None,
            task_payload: None,
            incoming_ray_payload: None,
        }];
        Self::validated(module)?.glsl(version, STUB)
    }

    fn entry(&self, name: &str) -> Result<&naga::EntryPoint, TranspileError> {
        self.module.entry_points.iter().find(|entry| entry.name == name).ok_or_else(|| TranspileError::NoEntryPoint {
            name: name.to_owned(),
            present: self.entry_points().collect::<Vec<_>>().join(", "),
        })
    }
}

/// Name of the empty entry point of [`Shader::glsl_library`].
const STUB: &str = "antumbra_stub";

/// An error and its causes, in one line.
fn causes(error: &dyn core::error::Error) -> String {
    let mut message = error.to_string();
    let mut next = error.source();
    while let Some(cause) = next {
        message.push_str(": ");
        message.push_str(&cause.to_string());
        next = cause.source();
    }
    message
}

fn not_written(target: &'static str, error: &dyn core::error::Error) -> TranspileError {
    TranspileError::Write { target, message: causes(error) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOST: &str = "
        fn used() -> f32 { return 1.0; }
        fn unused() -> f32 { return 2.0; }
        @fragment fn shade() -> @location(0) vec4f { return vec4f(used()); }
        @vertex fn place() -> @builtin(position) vec4f { return vec4f(unused()); }";

    #[test]
    fn errors_are_one_line_and_name_what_is_legal() {
        let parse = Shader::parse("\n\nfn f( {}").unwrap_err();
        assert!(parse.to_string().starts_with("line 3 is not WGSL: "), "{parse}");
        let invalid = Shader::parse("fn f() -> f32 { }").unwrap_err();
        assert!(matches!(invalid, TranspileError::Validate { .. }), "{invalid}");
        let absent = Shader::parse(HOST).unwrap().keep(&["shadow"]).unwrap_err();
        assert_eq!(absent.to_string(), "entry point is shadow; legal: one of [shade, place]");
        for error in [parse, invalid, absent] {
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    }

    #[test]
    fn what_nobody_calls_goes() {
        let shader = Shader::parse(HOST).unwrap().keep(&["shade"]).unwrap();
        let names: Vec<_> = shader.module.functions.iter().filter_map(|(_, f)| f.name.as_deref()).collect();
        assert_eq!(names, ["used"]);
        assert_eq!(shader.entry_points().collect::<Vec<_>>(), ["shade"]);
    }
}
