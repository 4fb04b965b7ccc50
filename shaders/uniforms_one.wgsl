struct AntumbraUniforms {
    view: AntumbraView,
}
