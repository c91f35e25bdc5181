//! The effects of a scene, and the two kernels, as facts.

use crate::bound::sample_scale;
use crate::effects::{self, Effect, Effects};
use crate::gpu::device_parts;
use crate::kernel::{
    self, Kernel, Packed, SPHERE_CAPACITY, UNROLLED_BOUNCES, UNROLLED_SPHERES, spirv, validate,
};
use crate::scene::{Scene, Sphere};
use crate::viewpoint::Viewpoint;
use serde::Serialize;

/// Spheres that are named for each effect; of more, the others are counted.
pub const NAMED: usize = 3;

/// Whether and why a kernel has an effect.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Account {
    /// Its name.
    pub effect: &'static str,
    /// Whether the scene calls for it.
    pub called_for: bool,
    /// What it does to the spheres that call for it, their names to follow; or why none does.
    pub why: &'static str,
    /// How many spheres call for it.
    pub spheres: usize,
    /// What the first of them are called, at most [`NAMED`].
    pub named: Vec<String>,
}

impl Account {
    fn of(effect: Effect, scene: &Scene, viewpoint: &Viewpoint) -> Self {
        let causes = || effects::causes(effect, scene, viewpoint);
        let left_out = effects::left_out(effect, scene, viewpoint);
        Self {
            effect: effect.name(),
            called_for: left_out.is_none(),
            why: left_out.unwrap_or(effect.role()),
            spheres: causes().count(),
            named: causes().take(NAMED).map(name).collect(),
        }
    }

    /// The sentence: why it is there and for which spheres, or why it is not.
    #[must_use]
    pub fn sentence(&self) -> String {
        if !self.called_for {
            return self.why.to_owned();
        }
        let others = self.spheres - self.named.len();
        let spheres = match (others, self.named.as_slice()) {
            (0, [one]) => one.clone(),
            (0, [first @ .., last]) => format!("{} and {last}", first.join(", ")),
            (others, named) => format!("{} and {others} more", named.join(", ")),
        };
        format!("{} {spheres}", self.why)
    }
}

/// What the table calls a sphere: its name alone, if it has one.
fn name(sphere: &Sphere) -> String {
    if sphere.name().is_some() { sphere.label() } else { sphere.title() }
}

/// One of the two kernels for a scene, ready to be compiled.
#[derive(Debug, Clone)]
pub struct Version {
    /// The scene as it goes to the device with it.
    pub packed: Packed,
    /// What it is composed for.
    pub kernel: Kernel,
}

impl Version {
    /// The kernel that a scene calls for, and no more: the one that renders it.
    #[must_use]
    pub fn specialised(scene: &Scene, viewpoint: &Viewpoint) -> Self {
        Self::of(scene, viewpoint, Effects::of(scene, viewpoint))
    }

    /// The kernel with every effect under the same estimator.
    #[must_use]
    pub fn general(scene: &Scene, viewpoint: &Viewpoint) -> Self {
        Self::of(scene, viewpoint, Effects::general(scene))
    }

    fn of(scene: &Scene, viewpoint: &Viewpoint, effects: Effects) -> Self {
        let packed = kernel::pack(scene, viewpoint, effects, sample_scale(scene));
        Self { kernel: Kernel::of(scene, effects, &packed), packed }
    }
}

/// What is known of a kernel without running it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Facts {
    /// Bytes of its WGSL.
    pub wgsl_bytes: usize,
    /// Functions in it, the entry point included.
    pub functions: usize,
    /// Bytes of its SPIR-V, which is what a Vulkan driver compiles.
    pub spirv_bytes: usize,
    /// How the sphere is found that a ray meets, and why so.
    pub search: String,
    /// How a path is followed from segment to segment, and why so.
    pub paths: String,
    /// Which kind of buffers hold the spheres, and why.
    pub buffers: String,
    /// Bytes on the device, buffer by buffer.
    pub device_bytes: Vec<(&'static str, u64)>,
}

impl Facts {
    fn of(version: &Version) -> Result<Self, String> {
        let Version { packed, kernel } = version;
        let wgsl = kernel.wgsl();
        let (module, _) = validate(&wgsl)?;
        Ok(Self {
            wgsl_bytes: wgsl.len(),
            functions: module.functions.len() + module.entry_points.len(),
            spirv_bytes: 4 * spirv(&wgsl)?.len(),
            search: search(version),
            paths: paths(kernel),
            buffers: buffers(packed),
            device_bytes: device_parts(packed, kernel.size),
        })
    }

    /// Bytes on the device in all.
    #[must_use]
    pub fn total_device_bytes(&self) -> u64 {
        self.device_bytes.iter().map(|(_, bytes)| bytes).sum()
    }
}

fn search(version: &Version) -> String {
    let Version { packed, kernel } = version;
    let spheres = packed.spheres.len();
    let below = packed.scene.hierarchy_count as usize;
    match (kernel.written.is_some(), kernel.effects.has(Effect::Hierarchy)) {
        (true, _) => {
            format!("written out: {}, at most {UNROLLED_SPHERES}", count(spheres, "sphere"))
        }
        (_, false) => format!("a loop: {spheres} spheres, more than {UNROLLED_SPHERES}"),
        _ if below == spheres => format!("a hierarchy over {}", count(spheres, "sphere")),
        _ => format!(
            "a hierarchy over {}, a loop over {}",
            count(below, "sphere"),
            count(spheres - below, "other")
        ),
    }
}

fn paths(kernel: &Kernel) -> String {
    let bounces = count(kernel.bounces as usize, "bounce");
    if !kernel.scatters() {
        "one segment: nothing scatters".to_owned()
    } else if kernel.writes_paths() {
        format!("written out: {bounces}, at most {UNROLLED_BOUNCES}")
    } else if kernel.effects.has(Effect::Hierarchy) {
        "a loop, as under every hierarchy".to_owned()
    } else {
        format!("a loop: {bounces}, more than {UNROLLED_BOUNCES}")
    }
}

fn buffers(packed: &Packed) -> String {
    if !packed.is_stored() {
        format!("uniform: room for {SPHERE_CAPACITY} spheres")
    } else if packed.nodes.is_empty() {
        format!("storage: more than {SPHERE_CAPACITY} spheres")
    } else {
        "storage, as under every hierarchy".to_owned()
    }
}

fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// What a scene calls for, and the two kernels, as far as no device is needed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Explanation {
    /// Every effect there is.
    pub effects: Vec<Account>,
    /// The kernel that the scene calls for.
    pub specialised: Facts,
    /// The kernel with every effect under the same estimator.
    pub general: Facts,
}

impl Explanation {
    /// Explains the kernels of a scene.
    ///
    /// # Errors
    /// naga's message if it refuses one of them, which is a mistake in candor.
    pub fn of(
        scene: &Scene,
        viewpoint: &Viewpoint,
        specialised: &Version,
        general: &Version,
    ) -> Result<Self, String> {
        Ok(Self {
            effects: Effect::all().map(|effect| Account::of(effect, scene, viewpoint)).collect(),
            specialised: Facts::of(specialised)?,
            general: Facts::of(general)?,
        })
    }
}
