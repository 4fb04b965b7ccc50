// What an engine does with the light that arrives, at the least: Lambert's cosine,
// for which it needs the normal anyway.
const TO_SUN: vec3f = vec3f(0.36, 0.8, 0.48);

fn shade(light: f32, normal: vec3f) -> f32 {
    return light * max(dot(normal, TO_SUN), 0.0);
}
