#!/usr/bin/python3
"""peers.py PROGRAM: the same tables to our statistics (statistics_of_csv) and to Debian's SciPy and statsmodels.

What is computed agrees within 1e-9, relative above 1; what is drawn within five standard errors of the drawing."""
import math
import subprocess
import sys
import tempfile
import warnings

try:
    import numpy as np
    from scipy import special, stats
    import statsmodels.formula.api as formula
    from statsmodels.stats.anova import anova_lm
    from statsmodels.stats.multitest import multipletests
    from statsmodels.stats.weightstats import DescrStatsW
except ImportError as error:
    print(f"{error.name} is not installed: nothing to compare with (python3-scipy, python3-statsmodels)")
    sys.exit(0)

RESAMPLES = 20000  # as in statistics_of_csv.cpp
FLIPS = 10000
wrong = 0
compared = {"computed": 0, "drawn": 0}


def agree(name, ours, theirs, tolerance=None):
    """tolerance: five standard errors of what is drawn; without, 1e-9."""
    global wrong
    compared["drawn" if tolerance else "computed"] += 1
    allowed = tolerance or 1e-9 * max(1.0, abs(theirs))
    if not abs(ours - theirs) <= allowed:
        print(f"{name}: ours {ours:.12g}, theirs {theirs:.12g}, allowed difference {allowed:.3g}")
        wrong += 1


def table(people, rounded, seed):
    """Two measures of every pair of people, nobody their own source; rounded ones have ties."""
    chance = np.random.default_rng(seed)
    source, target = np.array([(i, j) for i in range(people) for j in range(people) if i != j]).T
    x = (2 + 0.3 * chance.normal(size=people)[source] + 0.5 * chance.normal(size=people)[target]
         + 0.2 * chance.normal(size=source.size))
    y = 0.4 + 0.8 * x + 0.25 * chance.normal(size=source.size)
    if rounded:
        x, y = x.round(1), y.round(1)
    return {"x": x, "y": y, "p": chance.uniform(size=x.size) ** 2, "source": source, "target": target}


def ours(program, columns):
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join(repr(value.item()) for value in row) + "\n")
        file.flush()
        lines = subprocess.run([program, file.name], check=True, capture_output=True, text=True).stdout.splitlines()
    return {name: float(value) for name, value in (line.split() for line in lines)}


def compare_tests(name, mine, c):
    x, y, d = c["x"], c["y"], c["x"] - c["y"]
    check = lambda key, theirs: agree(f"{name} {key}", mine[key], theirs)
    described = DescrStatsW(x)
    check("mean", described.mean)
    check("sd", np.sqrt(described.var_ddof(1)))
    check("median", np.median(x))
    check("rms", np.sqrt(np.mean(x ** 2)))
    check("p05", np.quantile(x, 0.05))
    check("p95", np.quantile(x, 0.95))
    low, high = described.tconfint_mean(alpha=0.1)
    check("t_interval.low", low)
    check("t_interval.high", high)
    t = stats.ttest_rel(x, y)
    check("t", t.statistic)
    check("t.p", t.pvalue)
    check("t.difference.low", t.confidence_interval(0.95).low)
    check("t.difference.high", t.confidence_interval(0.95).high)
    normal = stats.wilcoxon(d, method="approx")
    check("wilcoxon.normal.p", normal.pvalue)
    agree(f"{name} wilcoxon", min(mine["wilcoxon.positive"], mine["wilcoxon.negative"]), normal.statistic)
    exact = np.unique(np.abs(d)).size == d.size and d.size <= 50
    agree(f"{name} wilcoxon.exact", mine["wilcoxon.exact"], float(exact))
    check("wilcoxon.p", stats.wilcoxon(d, method="exact").pvalue if exact else normal.pvalue)
    check("dz", np.mean(d) / np.std(d, ddof=1))
    m = d.size - 1
    check("hedges", np.exp(special.gammaln(m / 2) - special.gammaln((m - 1) / 2)) / np.sqrt(m / 2))
    check("cliff", 2 * stats.mannwhitneyu(x, y).statistic / (x.size * y.size) - 1)
    half = stats.norm.ppf(0.975)
    pearson, spearman, kendall = stats.pearsonr(x, y), stats.spearmanr(x, y), stats.kendalltau(x, y)
    for key, theirs, error in (("pearson", pearson, 1 / np.sqrt(x.size - 3)),
                               ("spearman", spearman, np.sqrt((1 + spearman[0] ** 2 / 2) / (x.size - 3))),
                               ("kendall", kendall, np.sqrt(0.437 / (x.size - 4)))):
        check(key, theirs[0])
        check(f"{key}.p", theirs[1])
        check(f"{key}.interval.low", np.tanh(np.arctanh(theirs[0]) - half * error))
        check(f"{key}.interval.high", np.tanh(np.arctanh(theirs[0]) + half * error))
    check("pearson.interval.low", pearson.confidence_interval().low)
    for key, method in (("benjamini-hochberg", "fdr_bh"), ("benjamini-yekutieli", "fdr_by")):
        for k, q in enumerate(multipletests(c["p"], method=method)[1]):
            check(f"{key}.{k}", q)


def compare_variances(name, mine, c):
    check = lambda key, theirs: agree(f"{name} {key}", mine[key], theirs)
    # Squares of each factor after the other: statsmodels' type 2.
    anova = anova_lm(formula.ols("x ~ C(source) + C(target)", c).fit(), typ=2)
    residual = anova["sum_sq"]["Residual"] / anova["df"]["Residual"]
    variances = {"residual": residual}
    for factor, other in (("source", "target"), ("target", "source")):
        row = anova.loc[f"C({factor})"]
        check(f"{factor}.f", row["F"])
        check(f"{factor}.p", row["PR(>F)"])
        check(f"{factor}.degrees", row["df"])
        # What the factor's columns are beside those of the other: the trace is the weight of its variance.
        own, others = (np.eye(c[key].max() + 1)[c[key]] for key in (factor, other))
        beside = own - others @ np.linalg.lstsq(others, own, rcond=None)[0]
        variances[factor] = (row["sum_sq"] - row["df"] * residual) / np.trace(beside.T @ own)
    for key, variance in variances.items():
        check(f"{key}.variance", variance)
        check(f"{key}.share", max(variance, 0) / sum(max(v, 0) for v in variances.values()))
    n, k = c["x"].size, 2
    rated = np.stack([c["x"], c["y"]])
    things, raters = rated.mean(0), rated.mean(1)
    rest = rated - things - raters[:, None] + rated.mean()
    between, judges, error = k * things.var(ddof=1), n * raters.var(ddof=1), (rest ** 2).sum() / (n - 1)
    check("icc", (between - error) / (between + (k - 1) * error + k * (judges - error) / n))
    check("icc.f", between / error)
    check("icc.p", stats.f.sf(between / error, n - 1, n - 1))


def drawn_ends(values, shares):
    """Quantiles of drawn values, and five standard errors of the difference of two such draws."""
    for share in shares:
        step = 5 * math.sqrt(2 * share * (1 - share) / RESAMPLES)  # of the share
        end = np.quantile(values, share)
        yield end, max(abs(np.quantile(values, min(1, max(0, share + sign * step))) - end) for sign in (-1, 1))


def compare_bootstrap(name, mine, key, values, estimate, without=None):
    """values: of the peer's resamples. without: what the statistic is without each case."""
    for side, (end, allowed) in zip(("low", "high"), drawn_ends(values, (0.025, 0.975))):
        agree(f"{name} {key}.percentile.{side}", mine[f"{key}.percentile.{side}"], end, allowed)
    agree(f"{name} {key}.error", mine[f"{key}.error"], values.std(ddof=1), 5 * values.std() / math.sqrt(RESAMPLES))
    # Samples that drew everybody once give the estimate, but for rounding.
    below = ((values < estimate - 1e-12).mean() + (values <= estimate + 1e-12).mean()) / 2
    z0_error = 5 * math.sqrt(2 * below * (1 - below) / RESAMPLES) / stats.norm.pdf(stats.norm.ppf(below))
    agree(f"{name} {key}.z0", mine[f"{key}.z0"], stats.norm.ppf(below), z0_error)
    if without is None:
        return
    influence = without.mean() - without
    agree(f"{name} {key}.a", mine[f"{key}.a"], (influence ** 3).sum() / (6 * (influence ** 2).sum() ** 1.5))


def scipys_interval(name, mine, key, data, statistic, estimate, without):
    """Against scipy.stats.bootstrap as it is, of cases that know nothing of each other."""
    for kind, method in (("percentile", "percentile"), ("bca", "BCa")):
        result = stats.bootstrap(data, statistic, paired=True, vectorized=True, n_resamples=RESAMPLES, method=method,
                                 confidence_level=0.95, random_state=np.random.default_rng(8))
        values = result.bootstrap_distribution
        if kind == "percentile":
            compare_bootstrap(name, mine, key, values, estimate, without)
        # The ends of bca also move with z0: as much again, and more.
        for side, end, share in (("low", result.confidence_interval.low, 0.025),
                                 ("high", result.confidence_interval.high, 0.975)):
            _, allowed = next(drawn_ends(values, (share,)))
            allowed *= 3 if kind == "bca" else 1
            agree(f"{name} {key}.{kind}.{side}", mine[f"{key}.{kind}.{side}"], end, allowed)


def compare_resampled(name, mine, c):
    x, y, n = c["x"], c["y"], c["x"].size
    scipys_interval(name, mine, "rows.mean", (x,), lambda v, axis=-1: v.mean(axis=axis), x.mean(),
                    (x.sum() - x) / (n - 1))
    scipys_interval(name, mine, "rows.ratio", (y, x), lambda a, b, axis=-1: a.sum(axis=axis) / b.sum(axis=axis),
                    y.sum() / x.sum(), (y.sum() - y) / (x.sum() - x))
    # SciPy has no clusters: weights as they are defined.
    chance = np.random.default_rng(9)
    people = c["source"].max() + 1
    sources, targets = (chance.multinomial(people, np.full(people, 1 / people), size=RESAMPLES) for _ in range(2))
    for key, weights in (("one_way.mean", targets[:, c["target"]]),
                         ("two_way.mean", sources[:, c["source"]] * targets[:, c["target"]]),
                         ("people.mean", sources[:, c["source"]] * sources[:, c["target"]])):
        weights = weights[weights.sum(1) > 0]
        compare_bootstrap(name, mine, key, weights @ x / weights.sum(1), x.mean())
    without = np.array([x[(c["source"] != k) & (c["target"] != k)].mean() for k in range(people)])
    influence = without.mean() - without
    agree(f"{name} people.mean.a", mine["people.mean.a"], (influence ** 3).sum() / (6 * (influence ** 2).sum() ** 1.5))
    sums = np.bincount(c["target"], x - y)
    for key, d in (("rows", x - y), ("targets", sums)):
        exact = d.size <= 16
        agree(f"{name} {key}.flips.exact", mine[f"{key}.flips.exact"], float(exact))
        count = np.inf if d.size <= 12 else FLIPS - 1
        p = stats.permutation_test((d,), np.sum, vectorized=True, permutation_type="samples", n_resamples=count,
                                   random_state=np.random.default_rng(10)).pvalue
        # SciPy doubles the smaller tail; of signs the two are mirror images. It adds 1 to both tails of what it draws.
        error = 5 * math.sqrt(2 * p * (1 - p) / FLIPS) + 2 / FLIPS
        agree(f"{name} {key}.flips.p", mine[f"{key}.flips.p"], p, None if exact and d.size <= 12 else error)
        agree(f"{name} {key}.flips.drawn.p", mine[f"{key}.flips.drawn.p"], p, error)


def main():
    warnings.filterwarnings("ignore", message=".*exact p-value.*")
    for name, people, rounded in (("few", 4, False), ("some", 7, False), ("ties", 7, True), ("many", 14, False)):
        c = table(people, rounded, seed=people + rounded)
        mine = ours(sys.argv[1], c)
        compare_tests(name, mine, c)
        compare_variances(name, mine, c)
        compare_resampled(name, mine, c)
    print(f"{compared['computed']} computed and {compared['drawn']} drawn numbers compared, {wrong} differ")
    return 1 if wrong else 0


sys.exit(main())
