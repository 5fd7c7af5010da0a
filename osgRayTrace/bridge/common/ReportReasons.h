// ReportReasons.h - lists the keys of the conversion's report with their words. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace::engine
{

/// A class is the part of a key up to the point, with its heading in the report.
struct ReportClass
{
    const char* prefix;
    const char* title;
};

/// The classes stand in the order of the report.
constexpr ReportClass kReportClasses[] = {
    {"converted.", "Ray traced"},
    {"traced.", "Ray traced by a rule, or for shadows, mirrors and light alone"},
    {"rasterized.", "Has triangles, but is left to OSG to draw"},
    {"not-traced.", "Cannot be ray traced: drawn by OSG where there is a viewer"},
    {"approximated.", "Ray traced, but not with all that OpenGL does"},
    {"unused.", "Does nothing, as in OpenGL"},
    {"repaired.", "Bad values that were replaced"},
    {"warned.", "Ray traced as it is, but worth a look"},
    {"missing.", "Files that cannot be read"},
    {"skipped.", "Bad data, left out"},
};

struct ReportReason
{
    const char* key;     ///< "<class>.<reason>"
    const char* meaning; ///< meaning of the key as in docs/coverage.md
    /// warnAboutGeometry says this after the number for each geometry; null: it says nothing.
    const char* warning = nullptr;
};

/// This is the one list of the keys of Statistics::conversion. A new key takes a row here and in
/// the table of docs/coverage.md; a test compares both with the sources. Warnings follow this
/// order.
constexpr ReportReason kReportReasons[] = {
    {"converted.geometry", "drawables"},
    {"converted.instance", "uses of meshes, each with its place and its material"},
    {"converted.point", "points, traced as spheres"},
    {"converted.line", "line segments, traced as capsules"},
    {"converted.culled", "uses of drawables that a cull traversal places or gives their state"},
    {"converted.volume", "osgVolume's tiles"},
    {"converted.isosurface", "isosurfaces of osgVolume's tiles, traced as meshes"},
    {"converted.light", "lights of the scene"},
    {"converted.area-light", "area lights among them"},
    {"converted.environment-light", "the environment light"},
    {"converted.headlight", "the viewer's own light, from behind the eye"},
    {"converted.sky-light", "the viewer's own light, from above"},

    {"traced.by-rule",
     "drawables that a rule of the material file or the application lets be traced"},

    {"rasterized.additive-blending", "drawables whose colour is added to what is behind"},
    {"rasterized.billboard", "billboards with something below them that OSG draws"},
    {"rasterized.blending", "drawables with other blend functions than straight alpha"},
    {"rasterized.clip-plane-attribute", "drawables that a ClipPlane of their state cuts"},
    {"rasterized.color-mask", "drawables with a colour mask"},
    {"rasterized.cull-callback", "subtrees with a cull callback that draws or pushes state"},
    {"rasterized.depth-range", "drawables whose depth range has no extent, such as skies"},
    {"rasterized.effect", "osgFX effects"},
    {"rasterized.foreign-node", "nodes of unknown classes that draw or push state in cull"},
    {"rasterized.hint", "drawables that are hinted to be drawn by OSG"},
    {"rasterized.logic-operation", "drawables with a logic operation"},
    {"rasterized.mixed-primitives", "drawables of a cull traversal with triangles and lines"},
    {"rasterized.polygon-mode", "drawables of lines or points by their polygon mode"},
    {"rasterized.polygon-stipple", "drawables with a polygon stipple"},
    {"rasterized.pushed-light", "drawables with a light that a cull traversal pushes"},
    {"rasterized.several-passes", "drawables that a cull traversal draws several times"},
    {"rasterized.shader-program", "drawables with a program"},
    {"rasterized.stencil", "drawables with a stencil test"},
    {"rasterized.texture-combine", "drawables with a TexEnvCombine"},
    {"rasterized.texture-without-image", "drawables with a texture that only OpenGL has"},
    {"rasterized.too-many-paths", "nodes after 4,194,304 paths, with all below them"},
    {"rasterized.view-mask", "drawables that the node masks of some views hide"},
    {"rasterized.volume", "osgVolume's volumes with a projection, a hull or another technique"},

    {"traced.proxy", "uses of surfaces that OSG draws, traced for all rays but the camera's"},

    {"not-traced.adjacency", "primitive sets with adjacency"},
    {"not-traced.billboard-child",
     "children of a billboard that are no drawables, or have no place"},
    {"not-traced.clipped-away", "drawables that are wholly beyond a clip plane"},
    {"not-traced.custom-drawable", "drawables of classes that are not known"},
    {"not-traced.custom-node", "leaves of other kits"},
    {"not-traced.hud-camera", "cameras that draw over or under the scene"},
    {"not-traced.indirect-draw", "indirect draws"},
    {"not-traced.light-points", "osgSim's light points"},
    {"not-traced.lines", "primitive sets of lines"},
    {"not-traced.mouse-handle", "drawables that osgManipulator hides from all views"},
    {"not-traced.no-vertices", "drawables without vertices"},
    {"not-traced.particles", "osgParticle's drawables, rain and snow"},
    {"not-traced.patches", "primitive sets of patches"},
    {"not-traced.points", "primitive sets of points"},
    {"not-traced.projection", "Projection nodes"},
    {"not-traced.render-to-texture-camera", "cameras that draw into a texture or an image"},
    {"not-traced.text", "osgText's texts"},
    {"not-traced.volume", "osgVolume's volumes that OSG would draw, without OpenGL"},

    {"approximated.absolute-texgen", "TexGenNodes of eye space, without a view"},
    {"approximated.absolute-transform", "transforms of eye space, without a view"},
    {"approximated.billboard", "billboards that turn to the eye, without a view"},
    {"approximated.blending", "drawables with other blend functions, traced with straight alpha"},
    {"approximated.clip-plane-attribute", "drawables that a ClipPlane of their state would cut"},
    {"approximated.coat-normal",
     "clear coats of thin walls, which have the bumps of the wall's normal map"},
    {"approximated.color-mask", "drawables with a colour mask"},
    {"approximated.cull-traversal",
     "nodes that may draw in cull, without a viewer: their cull traversal is not run"},
    {"approximated.depth-range", "drawables whose depth range has no extent, at their own depth"},
    {"approximated.draw-callback", "drawables with a draw callback, which is not called"},
    {"approximated.effect", "osgFX effects, of which the children are traced as they are"},
    {"approximated.environment-transform", "environment lights below a scale that differs by axis"},
    {"approximated.fog-coordinate", "drawables whose fog is by a coordinate of each vertex"},
    {"approximated.hardware-pose", "drawables that a program would pose"},
    {"approximated.instanced-draw", "primitive sets that are drawn several times, traced once"},
    {"approximated.light-model", "light models with another ambient light than the first"},
    {"approximated.logic-operation", "drawables with a logic operation, which is not done"},
    {"approximated.no-texture-coordinates",
     "textured or anisotropic materials without texture coordinates"},
    {"approximated.occluder", "occluders, which hide nothing"},
    {"approximated.pixel-format", "textures whose pixels cannot be read: magenta"},
    {"approximated.polygon-mode", "drawables of lines or points by their polygon mode, filled"},
    {"approximated.polygon-offset",
     "drawables with a polygon offset that are seen from behind, too"},
    {"approximated.polygon-stipple", "drawables with a polygon stipple, traced whole"},
    {"approximated.rasterize-hint", "drawables that are hinted to be drawn by OSG, without OpenGL"},
    {"approximated.shader", "drawables with a program, which is not run"},
    {"approximated.stencil", "drawables with a stencil test"},
    {"approximated.texture-environment", "textures with a TexEnvCombine, taken as MODULATE"},
    {"approximated.texture-size", "textures of more than 2^28 texels or 4 GiB: magenta"},
    {"approximated.texture-unit", "drawables with textures on units above 1, which are left out"},
    {"approximated.texture-without-image", "textures without an image, left out"},

    {"unused.light-replaced", "lights whose number another one takes later"},

    // The next eight rows concern geometry and stand in the order of their warnings.
    {"skipped.index-out-of-range", "triangles with an index beyond the vertex array",
     "triangles with an index beyond the vertex array, skipped"},
    {"skipped.not-finite", "triangles with a vertex that is NaN, infinite or out of range",
     "triangles with a vertex that is NaN, infinite or out of range, skipped"},
    {"skipped.point-or-line", "points and lines with a vertex that does not exist or is not finite",
     "points and lines with a vertex that does not exist or is not finite, skipped"},
    {"skipped.deprecated-data", "drawables with per-primitive bindings or array indices",
     "per-primitive bindings or array indices: call fixDeprecatedData, skipped"},
    {"skipped.vertex-type", "drawables with a vertex array of an unknown type",
     "vertex array of an unknown type, skipped"},
    {"repaired.normal", "normals that are zero, missing or not finite: face normals",
     "normals that are zero, missing or not finite, replaced by face normals"},
    {"warned.opposite-normals", "triangles whose normals look to their back",
     "triangles whose normals look to their back, lit by the side seen"},
    {"repaired.color", "colours that are missing or not finite: white",
     "colours that are missing or not finite, replaced by white"},
    {"repaired.texture-coordinate", "texture coordinates that are missing or not finite: 0",
     "texture coordinates that are missing or not finite, replaced by 0"},

    {"repaired.voxel", "values of osgVolume's images that are not finite: 0; or above 1e12"},
    {"repaired.environment-negative", "pixels of an environment below 0"},
    {"repaired.environment-not-finite", "pixels of an environment that are NaN or infinite"},
    {"repaired.environment-scale",
     "environment lights whose scale makes pixels brighter than 1e30"},
    {"repaired.environment-too-bright", "pixels of an environment that are too bright"},

    {"warned.cull-exception", "nodes that throw an exception in a cull traversal"},
    {"warned.far-vertices", "drawables whose vertices are far from their own origin"},
    {"warned.light-size", "names of light-sizes that no light has"},
    {"warned.material-name", "rules of the material file whose name nothing has"},
    {"warned.material-value", "rules of the material file that ask for what is not there"},
    {"warned.open-body", "uses of drawables with an interior that they do not enclose"},
    {"warned.too-many-points", "drawables with more than 524,288 points and line segments"},
    {"warned.trace-hint", "nodes that are hinted to be traced, but cannot be"},

    {"missing.environment-image", "images of environment lights"},
    {"missing.texture-image", "images of textures"},

    {"skipped.area-light", "area lights without an area, or not finite"},
    {"skipped.clip-plane", "clip planes that are not finite, or of a number above 7"},
    {"skipped.volume", "osgVolume's tiles without an image, a place or room"},
    {"skipped.degenerate", "triangles without an area"},
    {"skipped.medium-volume", "MediumVolumes without a medium or with a flat box, and all but one "
                              "of a scene that is no box"},
    {"skipped.environment-light", "environment lights without an image, or beside another one"},
    {"skipped.light", "lights that are not finite, or of a number above 16383"},
    {"skipped.not-finite-transform", "transforms that are not finite, with all below them"},
    {"skipped.projective-transform", "projective transforms, with all below them"},
    {"skipped.singular-transform", "transforms that leave things no area, with all below them"},
    {"skipped.too-deep", "nodes below 5000 others, without their children"},
    {"skipped.too-many-paths", "nodes after 4,194,304 paths, with all below them"},

    {"instance.invalid-transform", "instances whose matrix Embree does not take"},
};

} // namespace osgRayTrace::engine
