import nonsmooth as ns

scene = ns.Scene("elasto_plastic", potential="x**2/2", observable="plastic_strain_rate")
print(scene.state)  # the variables that determine the law of g
gamma2 = ns.asymptotic_variance(scene, tol=1e-4)
print(f"{gamma2.value:.5f}", gamma2.error < 1e-5)
sampled = ns.asymptotic_variance(scene, tol=0.1, method="monte_carlo", seed=1)
print(abs(sampled.value - gamma2.value) < 4 * sampled.error)
W = ns.crossing_probability(scene, threshold=0.5, horizons=[2, 4], p=100, method="asymptotic")
print(W["probability"].values.round(4))
