"""The classic scene in Mitsuba, and renders of it."""

import math
import time

import drjit
import mitsuba
import numpy

from classic import PLANES
from image import Image

# Dr.Jit's index of a sample has 32 bits; more samples than this go in several passes.
SAMPLES_PER_PASS = 1 << 27

# Passes have seeds of their own, so many to a seed of a render.
PASSES_MOST = 1000

# Paths end by chance from this depth on: never.
NO_ROULETTE = 1000

# Squares in place of planes reach so far. What is beyond gets less than 1e-5 of the light
# that the room gets, which falls with the square of the distance.
REACH = 1000.0


class PhongLobe(mitsuba.BSDF):
    """f_r = rho (n+1)/2pi cos^n(alpha) about the mirror direction, as candor has it.

    Mitsuba 3 comes without a Phong model. Dr.Jit compiles this class into the same kernel
    as Mitsuba's own models.
    """

    def __init__(self, properties):
        super().__init__(properties)
        self.albedo = mitsuba.Color3f(properties["albedo"])
        self.exponent = mitsuba.Float(properties["exponent"])
        kind = mitsuba.BSDFFlags.GlossyReflection | mitsuba.BSDFFlags.FrontSide
        self.m_flags = kind
        self.m_components = [kind]

    def density(self, si, wo):
        """(n+1)/2pi cos^n(alpha), per steradian."""
        cosine = drjit.maximum(drjit.dot(wo, mitsuba.reflect(si.wi)), 0.0)
        scale = (self.exponent + 1.0) * drjit.inv_two_pi
        return scale * drjit.power(cosine, self.exponent)

    def both_above(self, si, wo, active):
        """Light comes and goes on the outside."""
        up = mitsuba.Frame3f.cos_theta
        return active & (up(si.wi) > 0.0) & (up(wo) > 0.0)

    def sample(self, ctx, si, sample1, sample2, active=True):
        cosine = drjit.power(sample2.x, 1.0 / (self.exponent + 1.0))
        sine = drjit.safe_sqrt(1.0 - cosine * cosine)
        sin_phi, cos_phi = drjit.sincos(drjit.two_pi * sample2.y)
        around = mitsuba.Vector3f(sine * cos_phi, sine * sin_phi, cosine)
        found = mitsuba.BSDFSample3f(mitsuba.Frame3f(mitsuba.reflect(si.wi)).to_world(around))
        active = self.both_above(si, found.wo, active)
        found.pdf = drjit.select(active, self.density(si, found.wo), 0.0)
        found.eta = 1.0
        found.sampled_type = mitsuba.UInt32(+mitsuba.BSDFFlags.GlossyReflection)
        found.sampled_component = mitsuba.UInt32(0)
        return found, (self.albedo * mitsuba.Frame3f.cos_theta(found.wo)) & active

    def eval(self, ctx, si, wo, active=True):
        active = self.both_above(si, wo, active)
        return (self.albedo * self.density(si, wo) * mitsuba.Frame3f.cos_theta(wo)) & active

    def pdf(self, ctx, si, wo, active=True):
        return drjit.select(self.both_above(si, wo, active), self.density(si, wo), 0.0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def to_string(self):
        return "PhongLobe[]"


mitsuba.register_bsdf("phong_lobe", PhongLobe)


class Mitsuba:
    """Mitsuba's `path` on one scene."""

    def __init__(self, scene, world=None):
        """`world` are the objects in Mitsuba's terms, where not all are in `scene`."""
        self.description = scene
        self.scene = mitsuba.load_dict(world or objects(scene))
        self.pixels = scene["image"]["width"] * scene["image"]["height"]
        # Seconds that the first kernel of each sampler took to compile.
        self.compiling = {}
        drjit.set_flag(drjit.JitFlag.KernelHistory, True)

    def render(self, sampler, spp, seed, passes=1):
        """An image of at least `spp` samples a pixel; its seconds are without the
        compilation of kernels.

        The mean of `passes` passes with seeds of their own, or of more where that many
        samples need them. A stratified sampler's strata lie within one pass.
        """
        passes = max(passes, math.ceil(self.pixels * spp / SAMPLES_PER_PASS))
        share = math.ceil(spp / passes)
        sensor = mitsuba.load_dict(camera(self.description, sampler, share))
        total, wall, compiling = 0.0, 0.0, 0.0
        for number in range(passes):
            started = time.perf_counter()
            picture = mitsuba.render(
                self.scene, sensor=sensor, spp=share, seed=seed * PASSES_MOST + number
            )
            drjit.eval(picture)
            drjit.sync_thread()
            wall += time.perf_counter() - started
            compiling += compiled()
            total = total + numpy.array(picture, dtype=numpy.float64)
        self.compiling.setdefault(sampler, compiling)
        rgb = (total / passes).astype(numpy.float32)
        return Image(rgb, share * passes, wall - compiling)


def compiled():
    """Seconds that kernels took to compile since the last call."""
    kernels = [kernel for kernel in drjit.kernel_history() if "backend_time" in kernel]
    return sum(kernel["codegen_time"] + kernel["backend_time"] for kernel in kernels) / 1e3


def objects(scene):
    """The scene without its camera, as Mitsuba takes it."""
    path = {
        "type": "path",
        # Mitsuba counts the light's own emission as 1.
        "max_depth": scene["render"]["bounces"] + 1,
        "rr_depth": NO_ROULETTE,
        "hide_emitters": False,
    }
    return {"type": "scene", "integrator": path} | {
        f"sphere{number}": shape(sphere, scene["materials"])
        for number, sphere in enumerate(scene["spheres"])
    }


def camera(scene, sampler, spp):
    """The camera; its pixels weigh all of their samples alike."""
    eye, image = scene["camera"], scene["image"]
    place = mitsuba.ScalarTransform4f().look_at(
        origin=eye["position"], target=eye["look_at"], up=eye.get("up", [0.0, 1.0, 0.0])
    )
    film = {
        "type": "hdrfilm",
        "width": image["width"],
        "height": image["height"],
        "rfilter": {"type": "box"},
        "pixel_format": "rgb",
        "component_format": "float32",
    }
    return {
        "type": "perspective",
        "fov": eye["vertical_fov"],
        "fov_axis": "y",
        "to_world": place,
        "film": film,
        "sampler": {"type": sampler, "sample_count": spp},
    }


def shape(sphere, materials):
    """A sphere. Lights reflect nothing in candor; in Mitsuba they do unless told."""
    made = surface(sphere)
    if "emission" in sphere:
        black = {"type": "diffuse", "reflectance": rgb([0.0, 0.0, 0.0])}
        light = {"type": "area", "radiance": rgb(sphere["emission"])}
        return made | {"bsdf": black, "emitter": light}
    material = materials[sphere["material"]]
    if "diffuse" in material:
        return made | {"bsdf": {"type": "diffuse", "reflectance": rgb(material["diffuse"])}}
    lobe = {
        "type": "phong_lobe",
        "albedo": mitsuba.ScalarColor3f(material["glossy"]),
        "exponent": material["exponent"],
    }
    return made | {"bsdf": lobe}


def surface(sphere):
    """A sphere, or a square in place of one that stands for a plane."""
    center, radius = numpy.array(sphere["center"]), sphere["radius"]
    if radius < PLANES:
        return {"type": "sphere", "center": sphere["center"], "radius": radius}
    away = numpy.linalg.norm(center)
    inwards = -center / away
    middle = (radius - away) * inwards
    along = [0.0, 1.0, 0.0] if abs(inwards[1]) < 0.5 else [0.0, 0.0, 1.0]
    place = mitsuba.ScalarTransform4f().look_at(
        origin=middle.tolist(), target=(middle + inwards).tolist(), up=along
    )
    return {"type": "rectangle", "to_world": place.scale([REACH, REACH, 1.0])}


def rgb(values):
    """Linear RGB, as Mitsuba takes it."""
    return {"type": "rgb", "value": values}
