//! What a Vulkan driver is given.

use super::validate::validate;
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};

/// A kernel's WGSL as SPIR-V words, written by naga with the options that wgpu has for a driver
/// of Vulkan 1.3 with robust buffers: indices are kept in range, and loops bounded.
///
/// # Errors
/// naga's message.
pub fn spirv(wgsl: &str) -> Result<Vec<u32>, String> {
    let (module, info) = validate(wgsl)?;
    let options = spv::Options {
        lang_version: (1, 6),
        flags: spv::WriterFlags::LABEL_VARYINGS,
        bounds_check_policies: BoundsCheckPolicies {
            index: BoundsCheckPolicy::Restrict,
            buffer: BoundsCheckPolicy::Unchecked,
            ..BoundsCheckPolicies::default()
        },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::Native,
        force_loop_bounding: true,
        ..spv::Options::default()
    };
    spv::write_vec(&module, &info, &options, None).map_err(|error| error.to_string())
}
