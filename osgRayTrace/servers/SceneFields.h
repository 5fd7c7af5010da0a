// SceneFields.h - the members of what a Scene is made of, one by one, for messages. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/servers/Wire.h"

#include <memory>
#include <type_traits>

namespace osgRayTrace::engine
{

#if defined(__x86_64__) && defined(__linux__)
// Whoever adds a member to one of these adds it below, too. Names are for messages of the process
// that has the scene graph, and stay there. A test sends an edit of each member. A form of messages
// that others do not read has another kMessages: BuildIdentity.cpp.
static_assert(sizeof(Instance) == 72 && sizeof(Fog) == 28 && sizeof(Scene) == 240);
static_assert(sizeof(Medium) == 48 && sizeof(Atmosphere) == 80);
static_assert(sizeof(MaterialDetail) == 764 && sizeof(Material) == 616);
static_assert(sizeof(Texture) == 160 && sizeof(TextureMapping) == 136);
static_assert(sizeof(Light) == 256 && sizeof(EnvironmentImage) == 32 && sizeof(Environment) == 56);
static_assert(sizeof(Mesh) == 360);
static_assert(sizeof(VolumeImage) == 64 && sizeof(Volume) == 240);
#endif

template <> struct LastEnumerator<MaterialModel>
{
    static constexpr MaterialModel value = MaterialModel::Physical;
};
template <> struct LastEnumerator<VertexColorUse>
{
    static constexpr VertexColorUse value = VertexColorUse::AmbientAndDiffuse;
};
template <> struct LastEnumerator<TextureEnvironment>
{
    static constexpr TextureEnvironment value = TextureEnvironment::Add;
};
template <> struct LastEnumerator<AlphaTest>
{
    static constexpr AlphaTest value = AlphaTest::Always;
};
template <> struct LastEnumerator<FaceCulling>
{
    static constexpr FaceCulling value = FaceCulling::FrontAndBack;
};
template <> struct LastEnumerator<TextureWrap>
{
    static constexpr TextureWrap value = TextureWrap::ClampToBorder;
};
template <> struct LastEnumerator<TextureCoordinates>
{
    static constexpr TextureCoordinates value = TextureCoordinates::NormalMap;
};
template <> struct LastEnumerator<FogMode>
{
    static constexpr FogMode value = FogMode::ExponentialSquared;
};
template <> struct LastEnumerator<FogUse>
{
    static constexpr FogUse value = FogUse::Off;
};
template <> struct LastEnumerator<VolumeLaw>
{
    static constexpr VolumeLaw value = VolumeLaw::Samples;
};
template <> struct LastEnumerator<LightKind>
{
    static constexpr LightKind value = LightKind::Environment;
};

// Each of these functions hands the members of a part to an archive, a WireWriter or a WireReader,
// but for shared arrays and shared parts: SceneWire.cpp sends these.

template <class Archive> void fieldsOf(Archive& a, Instance& i)
{
    a(i.mesh, i.material, i.light, i.placed, i.mirrored, i.engineFromLocal, i.changed);
}

template <class Archive> void fieldsOf(Archive& a, TextureMapping& m)
{
    a(m.coordinates, m.transformed, m.matrix, m.partly, m.own, m.ownMatrix);
}

template <class Archive> void fieldsOf(Archive& a, FaceColors& f)
{
    a(f.ambient, f.diffuse, f.specular, f.emission, f.shininess, f.alpha);
}

template <class Archive> void fieldsOf(Archive& a, Fog& f)
{
    a(f.mode, f.radial, f.color, f.density, f.start, f.end);
}

template <class Archive> void fieldsOf(Archive& a, Medium& m)
{
    a(m.sigmaA, m.sigmaS, m.emission, m.anisotropy, m.dropletSize, m.priority);
}

template <class Archive> void fieldsOf(Archive& a, MaterialDetail& d)
{
    fieldsOf(a, d.interior);
    a(d.vertexColors, d.thinWalled, d.specular, d.specularColor, d.clearcoat, d.clearcoatRoughness,
      d.clearcoatNormalScale, d.sheenColor, d.sheenRoughness, d.anisotropy, d.anisotropyRotation,
      d.diffuseTransmission, d.diffuseTransmissionColor, d.iridescence, d.iridescenceIor,
      d.iridescenceThickness, d.normalScale, d.subsurface, d.subsurfaceRadius, d.textures);
    for (TexturePlace& place : d.places)
        a(place.set, place.u, place.v, place.offset);
}

/// The members of a material but `detail`.
template <class Archive> void fieldsOf(Archive& a, Material& m)
{
    a(m.model, m.ambient, m.diffuse, m.specular, m.shininess, m.lit, m.twoSidedLighting,
      m.lightMask);
    a.array(m.moreLights);
    a(m.vertexColorUse, m.textureEnvironment, m.environmentColor);
    fieldsOf(a, m.mapping);
    a(m.second.texture, m.second.environment, m.second.environmentColor);
    fieldsOf(a, m.second.mapping);
    a(m.separateSpecular, m.localViewer, m.hasBack);
    fieldsOf(a, m.back);
    a(m.baseColor, m.metallic, m.roughness, m.transmission, m.ior, m.emission, m.alpha, m.blended,
      m.alphaTest, m.alphaReference, m.culling, m.cullsAllRays, m.clockwise);
    fieldsOf(a, m.fog);
    a(m.baseColorTexture, m.metallicRoughnessTexture, m.transmissionTexture, m.emissionTexture,
      m.changed);
}

/// The members of a texture but `mips`.
template <class Archive> void fieldsOf(Archive& a, Texture& t)
{
    a(t.width, t.depth, t.height, t.cube, t.hasColor, t.hasAlpha, t.opaque, t.border, t.decodeSrgb,
      t.linearFilter, t.wrapS, t.wrapT, t.wrapR, t.blendsMips, t.changed);
    a.array(t.bytes);
    a.array(t.floats);
}

template <class Archive> void fieldsOf(Archive& a, EnvironmentImage& e)
{
    a(e.width, e.height);
    a.array(e.radiance);
}

template <class Archive> void fieldsOf(Archive& a, VolumeImage& v)
{
    a(v.width, v.height, v.depth, v.channels);
    a.array(v.bytes);
    a.array(v.floats);
}

/// The members of a volume but `image`.
template <class Archive> void fieldsOf(Archive& a, Volume& v)
{
    a.array(v.transfer);
    a(v.transferScale, v.transferOffset, v.imageFromEngine, v.tileFromEngine, v.law);
    fieldsOf(a, v.medium);
    a(v.transparency, v.cutoff, v.sampleRatio, v.sampleLength, v.lit, v.tint, v.changed);
}

/// The members of a light but `environment.image`.
template <class Archive> void fieldsOf(Archive& a, Light& l)
{
    a(l.kind, l.number, l.eyeSpace, l.castsShadows, l.ambient, l.diffuse, l.specular, l.position,
      l.direction, l.attenuationConstant, l.attenuationLinear, l.attenuationQuadratic, l.range,
      l.spotExponent, l.spotCosCutoff, l.radius, l.sine, l.corner, l.edgeU, l.edgeV, l.radiance,
      l.twoSided, l.instance, l.environment.mapFromEngine, l.environment.visible, l.changed);
}

/// The members of a scene but its parts.
template <class Archive> void fieldsOf(Archive& a, Scene& s)
{
    a(s.origin, s.unit, s.ambient, s.background, s.displayReferred, s.fogUse, s.ground, s.changed);
    bool hasAtmosphere = s.atmosphere != nullptr;
    a(hasAtmosphere);
    Atmosphere around = s.atmosphere ? *s.atmosphere : Atmosphere();
    if (hasAtmosphere)
    {
        fieldsOf(a, around.medium);
        a(around.centre, around.radius, around.scaleHeight, around.up);
    }
    if constexpr (std::is_same_v<Archive, WireReader>)
        s.atmosphere = hasAtmosphere ? std::make_shared<const Atmosphere>(around) : nullptr;
}

} // namespace osgRayTrace::engine
