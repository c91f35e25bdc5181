//! The identity of a scene: two films may be added only if their scenes agree.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;
use sha2::{Digest, Sha256};

use super::{Camera, Scene, Sphere, Surface};

/// Names the encoding; a change to the encoding changes this.
const TAG: &[u8] = b"candor scene 1\n";

/// SHA-256 of what a scene looks like; `Display` writes 64 lower-case hex digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SceneHash([u8; 32]);

impl SceneHash {
    /// The digest.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8; 32] {
        &self.0
    }
}

impl fmt::Display for SceneHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Reads what `Display` writes.
impl FromStr for SceneHash {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("expected 64 hexadecimal digits, not \"{text}\"");
        if text.len() != 64 || !text.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(expected());
        }
        let mut bytes = [0; 32];
        for (i, byte) in bytes.iter_mut().enumerate() {
            let digits = &text[2 * i..2 * i + 2];
            *byte = u8::from_str_radix(digits, 16).map_err(|_| expected())?;
        }
        Ok(Self(bytes))
    }
}

impl Scene {
    /// Identifies the picture that the scene describes: camera, size, and the spheres
    /// in order with their surfaces. Names, comments and `[render]` do not count, nor
    /// does the way to the same values: a material that two spheres share or one each.
    ///
    /// The encoding, little-endian and without padding, where a number is an `f64`
    /// with -0 written as 0:
    ///
    /// | bytes | what |
    /// |---|---|
    /// | 15 | `candor scene 1` and a newline |
    /// | 13 × 8 | camera: position, forward, right, up (x, y, z each), vertical field of view in radians |
    /// | 2 × 4 | width, height, as `u32` |
    /// | 8 | number of spheres, as `u64` |
    ///
    /// and for each sphere
    ///
    /// | bytes | what |
    /// |---|---|
    /// | 4 × 8 | centre, radius |
    /// | 1 | surface: 0 emitter, 1 diffuse, 2 glossy |
    /// | 3 × 8 | radiance or albedo: red, green, blue |
    /// | 8 | Phong exponent, of a glossy surface only |
    #[must_use]
    pub fn hash(&self) -> SceneHash {
        let mut encoder = Encoder(Sha256::new_with_prefix(TAG));
        encoder.camera(self.camera());
        encoder.0.update(self.size().width().to_le_bytes());
        encoder.0.update(self.size().height().to_le_bytes());
        encoder.0.update((self.spheres().len() as u64).to_le_bytes());
        for sphere in self.spheres() {
            encoder.sphere(sphere);
        }
        SceneHash(encoder.0.finalize().into())
    }
}

struct Encoder(Sha256);

impl Encoder {
    fn camera(&mut self, camera: &Camera) {
        for vector in [camera.position(), camera.forward(), camera.right(), camera.up()] {
            self.vector(vector);
        }
        self.number(camera.vertical_fov());
    }

    fn sphere(&mut self, sphere: &Sphere) {
        self.vector(sphere.center());
        self.number(sphere.radius());
        match sphere.surface() {
            Surface::Emitter(radiance) => self.surface(0, radiance.rgb()),
            Surface::Diffuse(albedo) => self.surface(1, albedo.rgb()),
            Surface::Glossy(albedo, exponent) => {
                self.surface(2, albedo.rgb());
                self.number(exponent.get());
            }
        }
    }

    fn surface(&mut self, kind: u8, rgb: DVec3) {
        self.0.update([kind]);
        self.vector(rgb);
    }

    fn vector(&mut self, vector: DVec3) {
        for component in vector.to_array() {
            self.number(component);
        }
    }

    fn number(&mut self, number: f64) {
        // -0 + 0 is 0, and every other number stays itself.
        self.0.update((number + 0.0).to_le_bytes());
    }
}
