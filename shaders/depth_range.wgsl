@group(0) @binding(0) var antumbra_depth: texture_depth_2d;
// Least and greatest depth, as bits: for numbers that are not negative they are ordered as the numbers are.
@group(0) @binding(1) var<storage, read_write> antumbra_range: array<atomic<u32>, 2>;

var<workgroup> antumbra_least: atomic<u32>;
var<workgroup> antumbra_most: atomic<u32>;

// Least and greatest depth of what was drawn; 0 and 1 are what buffers are cleared to.
@compute @workgroup_size(16, 16)
fn antumbra_depth_range(@builtin(global_invocation_id) pixel: vec3u, @builtin(local_invocation_index) index: u32) {
    if (index == 0u) {
        atomicStore(&antumbra_least, 0xffffffffu);
        atomicStore(&antumbra_most, 0u);
    }
    workgroupBarrier();
    if (all(pixel.xy < textureDimensions(antumbra_depth))) {
        let depth = textureLoad(antumbra_depth, pixel.xy, 0);
        if (depth > 0.0 && depth < 1.0) {
            atomicMin(&antumbra_least, bitcast<u32>(depth));
            atomicMax(&antumbra_most, bitcast<u32>(depth));
        }
    }
    workgroupBarrier();
    if (index == 0u) {
        atomicMin(&antumbra_range[0], atomicLoad(&antumbra_least));
        atomicMax(&antumbra_range[1], atomicLoad(&antumbra_most));
    }
}
