"""Renders one of the bench's scenes with Mitsuba 3: run by peer.py in Mitsuba's environment. Reads
a request as JSON from standard input, answers as JSON on standard output."""

import json
import sys
import time

import mitsuba as mi
import numpy as np


def rgb(value):
    return {"type": "rgb", "value": value if isinstance(value, list) else [value] * 3}


def placed(scene_object):
    """The mesh where the scene's "fit" has it: this high (y), its bounding box centred."""
    mesh = mi.load_dict({"type": kind_of(scene_object), "filename": scene_object["mesh"]})
    (fit,) = (step["fit"] for step in scene_object["transform"])
    low, high = np.array(mesh.bbox().min).ravel(), np.array(mesh.bbox().max).ravel()
    size = fit["height"] / (high[1] - low[1])
    transform = mi.ScalarTransform4f
    return (transform().translate(fit.get("centre", [0, 0, 0])).scale(float(size))
            .translate([float(x) for x in -(low + high) / 2]))


def kind_of(scene_object):
    return scene_object["mesh"].rsplit(".", 1)[1].lower()


def body(scene_object, material, coefficients):
    """Shape, smooth dielectric boundary and what is inside."""
    shape = {}
    if "mesh" in scene_object:
        shape.update(type=kind_of(scene_object), filename=scene_object["mesh"],
                     face_normals=scene_object["normals"] == "flat",
                     to_world=placed(scene_object))
    else:
        half = [0.5 * length for length in scene_object["size"]]
        shape.update(type="cube", to_world=mi.ScalarTransform4f().scale(half))
    g = coefficients["g"] or 0.0
    # Colours of a dictionary are at most 1, "scale" is not.
    absorbing = np.array(coefficients["sigmaAPerMm"])
    scattering = np.array(coefficients["sigmaSPrimePerMm"]) / (1 - g)
    extinction = absorbing + scattering
    shape["bsdf"] = {"type": "dielectric", "int_ior": material.get("eta", coefficients["eta"]),
                     "ext_ior": 1.0}
    shape["interior"] = {
        "type": "homogeneous", "scale": float(extinction.max()),
        "sigma_t": rgb((extinction / extinction.max()).tolist()),
        "albedo": rgb((scattering / extinction).tolist()),
        "phase": {"type": "hg", "g": g} if g else {"type": "isotropic"},
    }
    return shape


def light(settings):
    if settings["type"] == "environment":
        return {"type": "constant", "radiance": rgb(settings["radiance"])}
    place = mi.ScalarTransform4f().look_at(origin=settings["centre"], target=settings["lookAt"],
                                           up=[0, 1, 0])
    size = [0.5 * settings["width"], 0.5 * settings["height"], 1]
    return {"type": "rectangle", "to_world": place.scale(size),
            "emitter": {"type": "area", "radiance": rgb(settings["radiance"])}}


def load(scene, media):
    camera, film = scene["camera"], scene["film"]
    made = {
        "type": "scene",
        "integrator": {"type": "volpathmis", "max_depth": -1, "rr_depth": 64},
        "sensor": {
            "type": "perspective", "fov": camera["fovDegrees"], "fov_axis": "y",
            "to_world": mi.ScalarTransform4f().look_at(
                origin=camera["position"], target=camera["lookAt"], up=camera["up"]),
            "film": {"type": "hdrfilm", "width": film["width"], "height": film["height"],
                     "rfilter": {"type": "box"}, "pixel_format": "rgb",
                     "component_format": "float32"},
            "sampler": {"type": "independent"},
        },
    }
    for k, scene_object in enumerate(scene["objects"]):
        material = scene["materials"][scene_object["material"]]
        made[f"object{k}"] = body(scene_object, material, media[material["medium"]])
    for k, settings in enumerate(scene["lights"]):
        made[f"light{k}"] = light(settings)
    return mi.load_dict(made)


def picture_of(file):
    """{channel: pixels} of one of our pictures."""
    bitmap = mi.Bitmap(file)
    names = [field.name for field in bitmap.struct_()]
    pixels = np.array(bitmap, dtype=np.float64)
    return {name: pixels[..., k] for k, name in enumerate(names)}


def render(scene, samples, seed):
    """Pixels and CPU seconds."""
    began = time.process_time()
    image = np.array(mi.render(scene, spp=samples, seed=seed), dtype=np.float64)
    return image[..., :3], time.process_time() - began


def main():
    request = json.load(sys.stdin)
    mi.set_variant(request["variant"])
    ours = [picture_of(file) for file in request["ours"]]
    mask = ours[0]["A"] > 0
    scene = load(request["scene"], request["media"])
    render(scene, 1, 0)  # compiles
    means, seconds, total = [], [], 0
    for seed in range(request["seeds"]):
        image, spent = render(scene, request["samples"], 1 + seed)
        means.append(image[mask].mean(axis=0).tolist())
        seconds.append(spent)
        total = total + image
    mi.Bitmap((total / request["seeds"]).astype(np.float32)).write(request["picture"])
    print(json.dumps({
        "version": mi.__version__, "pixels": int(mask.sum()),
        "ours": [[picture[c][mask].mean() for c in "RGB"] for picture in ours],
        "peer": means, "seconds": seconds}))


if __name__ == "__main__":
    main()
