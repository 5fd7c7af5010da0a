// GlassBallFog.cpp - a glass ball in fog, lit by a spot light. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/MediumVolume>

#include <osg/LightSource>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

const Vec3 kBall(0.0f, 0.0f, 1.05f); ///< [m]
constexpr float kBallRadius = 0.45f;

/// Returns a spot light whose cone is as wide as the ball.
osg::ref_ptr<osg::LightSource> spot()
{
    const Vec3 from(-1.9f, 0.25f, 2.35f);
    Vec3 along = kBall - from;
    along.normalize();
    osg::ref_ptr<osg::Light> light = new osg::Light(1);
    light->setPosition(osg::Vec4(from, 1.0f));
    light->setDirection(along);
    light->setSpotCutoff(14.0f);
    light->setSpotExponent(0.0f);
    light->setAmbient(osg::Vec4(0, 0, 0, 1));
    light->setDiffuse(osg::Vec4(16.0f, 15.2f, 14.0f, 1));
    light->setSpecular(osg::Vec4(0, 0, 0, 1));
    light->setConstantAttenuation(0.0f);
    light->setQuadraticAttenuation(1.0f);
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setName("spot");
    source->setLight(light.get());
    return source;
}

} // namespace

osg::ref_ptr<osg::Group> glassBallFog()
{
    const SceneView view{Vec3d(0.3, -4.6, 1.3), Vec3d(0.1, 0.0, 1.0), Vec3d(0, 0, 1), 38.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("glass ball in fog", view, view);
    scene->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    scene->addChild(surface("walls",
                            {{Vec3(-2, -2, 0), Vec3(2.4f, -2, 0), Vec3(2.4f, 2, 0), Vec3(-2, 2, 0)},
                             {Vec3(-2, 2, 0), Vec3(2.4f, 2, 0), Vec3(2.4f, 2, 3), Vec3(-2, 2, 3)}},
                            lambert(Vec3(0.35f, 0.36f, 0.4f)).get()));
    scene->addChild(sphere("ball", kBall, kBallRadius, glass(1.5f).get()));
    scene->addChild(spot().get());
    const osg::ref_ptr<Medium> fog = new Medium;
    fog->setScattering(Vec3(0.14f, 0.14f, 0.15f));
    fog->setAbsorption(Vec3(0.01f, 0.01f, 0.01f));
    const osg::ref_ptr<MediumVolume> volume = new MediumVolume(fog.get());
    volume->setName("fog");
    scene->addChild(volume.get());
    return scene;
}

} // namespace osgRayTrace::data
