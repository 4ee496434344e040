"""flapenv/Heave-v0: one step is one wingbeat; hold height in gusts with the least power."""

from flapenv.coordinates import StrokeCoordinates
from flapenv.envs.describe import action_table, described, markdown_table, stroke_rows
from flapenv.envs.heave_batch import (
    HEIGHT_COST,
    HEIGHT_LIMIT,
    START_HEIGHT,
    START_VELOCITY,
    SUPPORT_UNIT,
    TYPICAL_GRAVITY,
    VELOCITY_LIMIT,
    VELOCITY_UNIT,
    WORST_BEAT,
    WORST_END,
    HeaveVectorEnv,
)
from flapenv.envs.single import SingleEnv
from flapenv.heave.trim import BOX


@described(
    actions=action_table(stroke_rows(BOX, StrokeCoordinates(BOX).axis_names)),
    observations=markdown_table(
        ("Num", "Observation"),
        [
            ("0", "z/R"),
            ("1", f"w/U in units of {VELOCITY_UNIT:g}"),
            ("2", f"last Λ - 1, mean over the beat, in units of {SUPPORT_UNIT:g}; 0 at the start"),
            ("3-7", "last action, clipped; the one that hovers at the start"),
            ("8", "AR - 4, aspect ratio of one wing"),
            ("9", "(r̂₁ - 0.51)/0.04, centre of area"),
            ("10", f"log(g/(f U)/{TYPICAL_GRAVITY:g}), how fast the body answers within a beat"),
        ],
    ),
    rewards=f"""-(P*/P*_hover - 1) - {HEIGHT_COST:g} (z/R)², z at the end of the beat; `info["reward/power"]` and
`info["reward/height"]`. A beat costs at most {WORST_BEAT:g}, more than the most wasteful stroke at the band's edge. A
row that is lost is charged that for every beat left, and {WORST_END:g}, `info["reward/lost"]`: an early end never pays,
whatever the other beats would have cost. At truncation height and speed are credited or charged at what they are
worth, within ±{WORST_END:g}, `info["reward/end"]`, so that letting go in the last beats does not pay either.""",
    starts=f"""An insect drawn uniformly, z in ±{START_HEIGHT:g} R, w in ±{START_VELOCITY:g} U, a gust from its
stationary distribution; or `options={{"insect": name, "height": z/R, "velocity": w/U}}`, each of them one value or one
for each row.""",
    ends=f"""Lost, and terminated, at |z| > {HEIGHT_LIMIT:g} R or |w| > {VELOCITY_LIMIT:g} U; truncated after `beats`
beats by the environment itself, without a wrapper.""",
)
class HeaveEnv(SingleEnv):
    """One step is one wingbeat: choose its kinematics; hold height in vertical gusts with the least power.

    ## Description
    An insect hovers in a horizontal stroke plane and may rise and sink. Its frequency is fixed at the one with which
    the best stroke of φmax = 75° carries its weight, so that all beats last the same. Over a beat the mean vertical
    force L(w - w_g, stroke) of Nabawy & Crowther's (2014, Part II) quasi-steady model, extended to heave, moves the
    body, m ẇ = L - m g: climbing lowers the angle of attack and damps. The gust w_g is steady within a beat and
    first-order autoregressive from beat to beat. Equations and the competitor, LQG: docs/heave.md.

    Heights are in wing lengths R, speeds in U = 4 f φmax R of the hovering stroke; z and w point upwards.

    ## Action space
    `Box(-1, 1, (5,), float32)`:

    {actions}

    Finite actions outside [-1, 1] are clipped, and `info["clipped"]` says so. NaN and inf are refused. With φmax alone
    off its hovering value the force goes either way; the hovering values of the other four are the best in the box.

    ## Observation space
    `Box(-5, 5, (11,), float32)`. The gust is not observed; it is in the infos.

    {observations}

    ## Rewards
    {rewards}

    ## Starting state
    {starts}

    ## Episode end
    {ends}

    ## Arguments
    `insect`, `beats`, `gusts`, `infos`, `dtype`, `render_mode` as in `HeaveVectorEnv`.

    ## Version history
    - v0: first version.
    """

    batch_class = HeaveVectorEnv
