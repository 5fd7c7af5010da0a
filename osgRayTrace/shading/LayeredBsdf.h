// LayeredBsdf.h - surfaces with layers, thin walls, anisotropy or a reflectance of their own.
// Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/BsdfTerms.h"

#include <optional>

namespace osgRayTrace::engine
{

/// The layers of a surface stand one over the other, and each gets what those above leave:
///
///   f = sheen D V                                                          [Estevez17, sect. 2]
///     + clearcoat Fc D G2 / (4 |wi.z wo.z|) min(Ss(wi), Ss(wo))
///     + reflection and transmission of Bsdf, with F', times min(S(wi), S(wo))
///     + diffuse/pi A(wi) A(wo) / A_avg
///     + diffuseTransmission/pi A(-wi) A(wo) / A_avg                for wi on the other side
///
///   Ss = 1 - max(sheen) Es        what the sheen leaves, Es from SheenAlbedo  [Estevez17, sect. 3]
///   S  = Ss (1 - clearcoat Ec)    what sheen and clear coat leave
///   A  = S (1 - E')               what reaches the base; A_avg is its mean, Bsdf::baseAverage
///
/// The smaller of both directions keeps reflection reciprocal and within 1; the base follows
/// [Kelemen01, sect. 3] through all layers, so that a white base keeps all energy. F' is the
/// reflectance F of a dielectric of index eta with another reflectance R at normal incidence,
///
///   F' = specular (R + (1 - R) (F - F0) / (1 - F0)),   F0 that of eta,
///
/// which is Schlick's form [glTF20, KHR_materials_specular] with the exact F. A thin wall has two
/// faces: light that goes to and fro between them makes 2 F' / (1 + F') of F', and the rest passes
/// without being bent, spread by rough walls as their reflection is, on the other side. Within a
/// body the layers are on the other side: light that leaves gets S of its direction outside.
///
/// A share of the surface, film, has the reflectance of ThinFilm.h in place of F' and of the
/// metal's S. A clear coat with a normal of its own has its terms around that normal, wi.z
/// included, and Ec is that of the cosine to it. D and G2 of the interface have the width
/// alphaTangent along tangent [Heitz18, eq. 1, 2]; the base below gets 1 - E of the azimuth at
/// which the facets reflect most: see CoatShape. Light that is diffused to the other side leaves
/// through an interface of the same kind, as from a leaf. If the surface is that of a clear body,
/// too, the terms of both sides differ, and diffuse transmission is not the same both ways there.
///
/// Light that comes out of the body below a diffuse boundary, Bsdf::leavesBody, has met A of its
/// way in already. What is left of f is diffuse/pi A(wi) / A_avg, whatever wo is.
std::optional<BsdfSample> sampleLayered(const Bsdf& bsdf, Vec3 wo, float uLobe, float u, float v,
                                        Transport transport);
BsdfValue evalLayered(const Bsdf& bsdf, Vec3 wo, Vec3 wi, Transport transport);
SpecularLobes layeredLobes(const Bsdf& bsdf, Vec3 wo);

/// Holds the two parts of a surface with Bsdf::subsurface.
struct SubsurfaceSplit
{
    Bsdf local;               ///< what the surface scatters where light meets it
    Bsdf leaving;             ///< what it does to light that leaves the body; diffuse is 1
    Vec3 color{0.0f};         ///< base colour
    Vec3 entering{0.0f};      ///< share of the light from or to wo that enters the body
    float probability = 0.0f; ///< with which a sample of the whole surface would be of this part
};

/// Parts a surface for a direction. walks: 1 in the channels in which light enters the body, and 0
/// in those in which the body is too dense, whose base stays as it is.
SubsurfaceSplit splitSubsurface(const Bsdf& bsdf, Vec3 wo, Vec3 walks);

/// Returns what light does that leaves the body of a surface, for the member leaving.
Bsdf leavingBody(const Bsdf& bsdf);

/// Returns A_avg of a surface, for the member of that name, by quadrature.
float baseAverageOf(const Bsdf& bsdf);

/// Returns the least a for which a film makes at most F' + a (1 - F') of F', for the member of that
/// name, at 8 angles. Over a body of the index of air F' is that of the film's own index.
float filmRiseOf(const Bsdf& bsdf);

/// Returns the share of the light that passes a smooth thin wall straight, for a direction with
/// this cosine to the normal.
Vec3 straightTransmittance(const Bsdf& bsdf, float cosTheta);

} // namespace osgRayTrace::engine
