struct AntumbraUniforms {
    views: array<AntumbraView, ANTUMBRA_MAPS>,
}
