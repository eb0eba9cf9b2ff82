"""A scene in, a library out: all programs of the scene, those of motion among them, one set-up.

The road, from a file to what is emitted; each line says what comes in, what goes out, and where:

    str            -> Scene                  scene.load
    Scene          -> Mechanism              mechanics.mechanism.mechanism
    Mechanism      -> Problem                mechanics.mechanism.Mechanism.problem
    Problem        -> Arrangement            lower.arrange.plan.arrange
    Arrangement    -> Value                  lower.lower.lower
    Value          -> Op, Operand            lower.setup.hot
    Arranged       -> Program                library.function.function
    Scene          -> Library                library.library.library
    Library        -> Measurement            verify.stated.figures
    Library, Measurement -> str              emit.c.source.c_files
    Library        -> str                    emit.casadi_text.casadi_file
    Library, Measurement -> str              emit.manifest.manifest

A problem is what the lecture says of a wanted function in a scene; an arrangement, in which order
to compute it. Steps in time enter at the library: they are made of the rate's program and of the
tensor.
"""
