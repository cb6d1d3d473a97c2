//! Every number that the method was given, with what it rests on.

/// Rate in Hz at which residuals are looked at, at least: twice the highest band below, and half again.
pub const RATE: f64 = 250.0;

/// Lowest rate of a recording in Hz: more than twice [`PLAIN_BAND`], the highest frequency that is looked at.
pub const LOWEST_RATE: f64 = 200.0;

/// Shortest recording in s: shorter ones hold less than a machine's motion.
pub const SHORTEST: f64 = 1.0;

/// Corner in Hz of the low-pass before that: below half the rate.
pub const PREFILTER: f64 = 100.0;

/// Corner in Hz of the low-pass that errors are looked at through, as agreed on with whoever reads them: most of a rattle and of
/// a sensor's noise lies above.
pub const ERROR_CORNER: f64 = 25.0;

/// Corner in Hz of the low-pass of coordinates before they are differentiated twice: noise grows with the
/// square of the frequency.
pub const CORNER: f64 = 80.0;

/// The same of forces that say where journals lean: there noise turns directions.
pub const LEAN_CORNER: f64 = 40.0;

/// Highest frequencies in Hz that are looked at: below the corner of the coordinates; laws and closure up to
/// nearly half the rate.
pub const DYNAMICS_BAND: f64 = 60.0;
/// See [`DYNAMICS_BAND`].
pub const PLAIN_BAND: f64 = 90.0;

/// Left out at both ends in s, where filters see beyond the recording.
pub const TRIM: f64 = 0.06;

/// Draws of sensor noise that a covariance is taken from.
pub const DRAWS: usize = 16;

/// Replicas of a machine whose joints rattle: the mean of six misses the true one by 40 % of a replica's own
/// scatter.
pub const REPLICAS: usize = 6;

/// The same for a prediction, which is the better for being the mean of more; a search compares models by the
/// same few.
pub const PREDICTING: usize = 12;

/// Root mean square of the difference of two replicas, in units of the sensor's noise, above which they differ
/// by more than sensors see: a tenth of the noise's variance.
pub const SEEN: f64 = 0.3;

/// The same below which two replicas are alike because nothing rattles, not by chance.
pub const NEARLY_SEEN: f64 = 0.02;

/// The same up to which one replica of a machine that falls stands for the other: a fit that takes its difference for noise
/// is then at most three times less certain than it could be.
pub const ALIKE: f64 = 3.0;

/// By how many times noise and what two replicas are apart they miss a column of a recording that others need not be held against:
/// the mean of two is off that of many by 0.7 of a replica's scatter, a tenth of that at most.
pub const BY_FAR: f64 = 10.0;

/// Drop of Σ of squares on data not used for the fit that an effect has to bring: twice the logarithm of a
/// thousand candidates, 14, and as much again for what noise is not white. Where joints rattle bias and noise come
/// from few replicas, and with others the same model may cost some 100 less: twice that (trials of the
/// 3-RPR; an effect three times as large as what hides it brings a thousand and more).
pub const GAIN: [f64; 2] = [28.0, 200.0];

/// The same for each value of an effect: Akaike's price of a parameter.
pub const GAIN_PER_VALUE: f64 = 2.0;

/// Most effects that are added: more than any machine was seen to need, so that a search ends.
pub const EFFECTS: usize = 5;

/// Drop of cost within which two hypotheses are as good as each other. One that is d standard deviations from the truth
/// costs `d² + 2 d z` more, z normal: by 10 less in one of a thousand recordings, whatever d. Where joints rattle, as much
/// as bias and noise from few replicas make of one and the same model ([`GAIN`]).
pub const TWINS: [f64; 2] = [10.0, 200.0];

/// Candidates that are simulated in place of an effect that was found, and the share of its part that they have to take
/// up by looks: what leaves a third of it is beaten by more than chance as soon as the effect shows at all.
pub const RIVALS: usize = 3;
/// See [`RIVALS`].
pub const RIVAL: f64 = 0.67;

/// Most that are simulated so where looks tell that the best of each kind does as well: wrong points of the links about a worn joint
/// took all three places, and were named in its place without the joint ever being simulated.
pub const KINDS: usize = 8;

/// Share of an effect's part by which looks are wrong: they do not rule out what takes up so little less of it. Of an oval
/// ring that was all that a machine lacked they said 1.4 % less than of an encoder's scale; of wrong points, 22 % less than
/// simulations did. Chosen with these two trials in sight; no others were run with it.
pub const BY_LOOKS: f64 = 0.02;

/// Share of the best gain from which on a rival stays one: the first of two effects is often taken for another that also takes
/// up a part of the second.
pub const NEAR: f64 = 0.7;

/// Hypotheses that are followed at once; candidates of each that are fitted by more than one linear step, and of
/// these that are simulated.
pub const HYPOTHESES: usize = 4;
/// See [`HYPOTHESES`].
pub const CLOSER: usize = 8;
/// See [`HYPOTHESES`].
pub const SIMULATED: usize = 5;

/// Starts that are fitted where those that promise most lead far off the machine: two of twelve led to the anchor that a spring at a
/// lever has, and most others near it.
pub const NEARER: usize = 12;

/// Candidates that are judged on data that they were not fitted to, of those that one linear step leaves least with on
/// the data that they were: three times as many as are [followed closer](CLOSER).
pub const JUDGED: usize = 24;

/// Share of what stands above noise from which an effect is mostly what is missing: where residuals show such a
/// one, what only simulations would show is not looked for.
pub const MOSTLY: f64 = 0.5;

/// Share of the best rival's drop of cost that a rival has to bring by its first simulation to be simulated again
/// at the values that this led to: what trials of the 3-RPR gave.
pub const PROMISING: f64 = 0.6;

/// Simulations of a run after which no further effect is looked for, those of a part of one counted as that part of it: what two
/// cores do in two minutes, at some 0.8 s for one of 3 s. Counted whole, those of every effect for a moment left no second round in
/// which a wrong point is seen beside a servo's gain (trial 1160000018). A round with four hypotheses beside each other takes some 150 of them where none of these is all that is missing.
pub const BUDGET: u64 = 300;

/// Steps of bodies in all simulations of a calibration after which nothing further is begun: some two minutes of two cores at
/// 4e5 of them a second each. The largest of twelve rigs takes 5.5e7; a chaotic pendulum of 5 cm, 3.9e5 in one run of 5.7 s, knew no end.
pub const WORK: u64 = 100_000_000;

/// How many times the steps of the declared machine a look at another model is worth, if these are more than [`WORK`] allows for
/// each of [`BUDGET`] simulations: contact laws that return less and less of a hit took 20 to 100 times as many on a pendulum of 5 cm,
/// more than all other effects together, and half as many where each was given up after ten times as many.
pub const STIFFER: u64 = 4;

/// Steps of bodies in simulations of each effect beside a model that residuals hardly see: less than half of that.
pub const MOMENT: u64 = 40_000_000;

/// What is missing, as a sum of squares in units of noise, that shows clearly: what takes up two thirds of it is told from what takes up
/// all by a [gain that no chance brings](GAIN), three times over.
pub const CLEARLY: f64 = 10.0 * GAIN[0];

/// The same in units of the squares by which replicas differ, from which simulations of more of a run tell effects apart: where an oval ring
/// changed as much as they do, others, each drawn once, seemed to explain more (1160000001).
pub const BEYOND_HITS: f64 = 2.0;

/// Sizes of a machine beyond which a place is afar: what sits there acts as if it had no place.
pub const AFAR: f64 = 2.0;

/// Drop of −2 log likelihood from which an effect has calmed the rattle of recordings, for each residual: misfits
/// of one and the same model of a 3-RPR with nine of them, settled again, were up to 1050 apart, and friction of
/// 0.11 in its journals brings 2700 and more.
pub const CALMER: f64 = 167.0;

/// Share of a swing that a model may be wrong by before its values are settled: a frequency that is off by a
/// thousandth has lost the phase after some seconds. Two swings of one size and any phase differ by √2 of it.
pub const MISSED: f64 = 0.3;

/// Mean square in units of noise, on each run, up to which a residual is noise: on data that candidates are judged
/// on, and on the run that values and the start were fitted to. There a variance from six replicas has a standard
/// deviation of 60 % where joints rattle, the start of a free machine is wrong by as much as noise leaves open, and
/// predictions have to meet the recording within [`MET`] floors besides.
pub const NOISE: [f64; 2] = [1.3, 2.0];

/// Its largest coefficient in units of noise, or as far as chance leads that of draws of it, whose rattle is not normal: of 1000
/// normal numbers one in a thousand runs has one of 5.
pub const LARGEST: f64 = 6.0;

/// Largest error after calibration, in floors, of a model that explains, in all columns of all runs.
pub const MET: f64 = 1.5;

/// Share of what stands above noise on data that a table of efforts was not fitted to that it has to remove: less
/// is chance.
pub const TABLE: f64 = 0.05;

/// How often a table is added to, its model simulated in between: what a look is wrong by depends on it.
pub const TABLE_PASSES: usize = 2;

/// Steps of time that differ from the median by a larger share came late, or early after a late one: an
/// ordinary clock is off by a thousandth.
pub const LATE: f64 = 0.02;

/// Share of steps that may do so, and the longest in medians: splines bridge a missing row or two, and of more
/// nobody knows what happened in between.
pub const LATE_SHARE: f64 = 0.1;
/// See [`LATE_SHARE`].
pub const LATE_STEPS: f64 = 3.5;

/// Lengths in s of the windows of a fit, one after another: a start that is wrong by a hundredth keeps its phase
/// in the first, and slow effects show in the last.
pub const WINDOWS: [f64; 4] = [0.2, 0.5, 1.2, 2.5];

/// Share of a motion that a model may miss over windows of one length for the next to be fitted: of a model that
/// lacks more, longer windows say how its errors grow.
pub const PHASE: f64 = 4e-3;

/// Time in s that windows of one fit cover together, at most: what two slow cores fit in a minute.
pub const COVERED: f64 = 45.0;

/// Drop of Σ of squares, as windows vary, that an effect of a fit with windows has to bring: as
/// [`GAIN`].
pub const CERTAIN: f64 = 28.0;

/// Share of a value's trace that the traces of others do not make up from which windows tell it apart: below that it
/// would be known a hundred times worse than by itself, and by what the model gets wrong rather than by it.
pub const TOLD: f64 = 1e-2;

/// First seconds of a run that its own zeros are taken from where a model is judged by the rest.
pub const OWN: f64 = 3.0;

/// Standard deviation in rad of a zero that nothing is known of: an operator sees a tenth.
pub const ZERO: f64 = 0.3;

/// Windows that predictions are judged by: length, and the first part that the start is fitted to, in s.
pub const HORIZONS: [[f64; 2]; 3] = [[0.5, 0.1], [0.3, 0.1], [2.5, 0.25]];

/// Share of a run's motion that the declared machine misses over half a second from which it does not move so at
/// all: a measured arm with unknown friction and zeros misses a third, radians read as degrees all of it.
pub const ASTRAY: f64 = 0.5;

/// Share that it misses at most where a column's scale is the only thing wrong: a tenth of a swing's stiffness is
/// half of that.
pub const FOLLOWED: f64 = 0.15;

/// Standard deviations by which an effect at its detection limit stands above what sees and names it: 49 of 50
/// are seen.
pub const SURE: f64 = 2.0;

/// Shares of the rate of sampling between which a sensor's noise is looked at: above what machines do, below
/// half the rate.
pub const NOISE_BAND: [f64; 2] = [0.40, 0.48];

/// Draws of the declared noise that it is held against: their mean is known to a tenth of one draw's scatter.
pub const NOISE_DRAWS: u64 = 8;

/// Ratio of a sensor's noise to what is declared from which it matters: half again in variance.
pub const OTHER_NOISE: f64 = 1.25;

/// Standard deviations by which it must differ: one of some thousand sensors does so by chance.
pub const SURE_NOISE: f64 = 4.0;

/// Ratio of what two variants of an effect leave within which looks do not tell which is right: what a look is wrong
/// by changes with the effect by as much.
pub const AS_MUCH: f64 = 2.0;

/// Corner in Hz of the low-pass of efforts in which events are looked for: a blow of 5 ms passes at half its height, and
/// what encoders' steps make of accelerations, which grows with the square of the frequency, does not.
pub const EVENT_CORNER: f64 = 40.0;

/// Shortest and longest stretch in s in which an event is looked for: a blow, and a push by hand. Longer ones show
/// as several.
pub const EVENT_WIDTHS: [f64; 2] = [0.02, 1.0];

/// Time in s in which the largest mean of a stretch is taken, to know what is usual.
pub const EVENT_BLOCK: f64 = 0.5;

/// Ratio of a stretch's mean to the median of the largest ones of all blocks, from which it is an event.
/// Chosen on five recordings of a two-link arm that hold none: after stretches at rest and jumps of readings are left
/// out none reaches it, and of 200 trials with a hidden torque on them three have one elsewhere.
pub const EVENT_SCORE: f64 = 3.0;

/// Ratio of the least event to the clearest stretch that is none: a gap between events and the rest. A choice.
pub const EVENT_RATIO: f64 = 1.2;

/// Time in s around an event in which no other one is looked for: filters smear it by 25 ms, and what a machine does
/// at its end belongs to it.
pub const EVENT_MARGIN: f64 = 0.1;

/// Share of a joint's root mean square rate below which it rests, over 80 ms: its friction then takes any value, and an
/// elbow that stuck for 0.3 s looked pushed. While it stuck its encoder's steps showed 0.04 rad/s, 0.006 of its rate.
pub const RESTING: f64 = 0.02;

/// Share of an event's impulse that is left at least when as much time before and after is counted in: half way
/// between a jump of a position, 0, and a push, 1.
pub const EVENT_STAYS: f64 = 0.5;

/// Events of one recording at most: a reader's patience.
pub const EVENTS: usize = 40;

/// Ratio of the scatters of two recordings' efforts, from which the calmer one says what is usual in the other: five
/// recordings of a two-link arm under different commands are within 2.3 of each other.
pub const RESTLESS: f64 = 3.0;

/// Share of an event's deviations from which another freedom is pushed as well.
pub const EVENT_SHARE: f64 = 0.5;

/// Rows in a recording for each function of the motion that is fitted to it, before events are looked for: 250 rows a
/// second hold some 25 that are independent.
pub const ROWS_A_FEATURE: usize = 40;

/// Share of the largest mean square of residuals that events may leave, where they do not leave noise: most of it is
/// theirs.
pub const CLEARED: f64 = 0.5;

/// Share of draws of noise that are beyond what chance is said to lead to: of some ten residuals, on one run or the other,
/// three in a hundred calibrations then have one that is.
pub const CHANCE: f64 = 0.003;

/// Factors by which units are mistaken: milli, centi, inches, degrees.
pub const FACTORS: [f64; 8] = [
    1e3,
    1e-3,
    1e2,
    1e-2,
    0.0254,
    1.0 / 0.0254,
    std::f64::consts::PI / 180.0,
    180.0 / std::f64::consts::PI,
];

/// Share by which a recording's rate may differ from its controller's: more is another machine.
pub const CLOCK: f64 = 1e-3;

/// Share by which recorded outputs of a controller may differ from what it makes of the recorded readings: a wrong unit
/// is beyond, and controllers as they are published are below.
pub const TOLERATED: f64 = 0.15;

/// Order and corner in Hz of the low-pass, forward and backward, through which outputs of sampled controllers are held
/// against the motion; and time in s that is left out at both ends, where it has no neighbours. As the published
/// figures of such recordings were had (Janot, Gautier, Brunot 2019): working motions have their share below 15 Hz.
pub const OUTPUT_FILTER: (usize, f64) = (4, 50.0);
/// See [`OUTPUT_FILTER`].
pub const OUTPUT_TRIM: f64 = 0.2;

/// Stretches in s over which models of such machines are compared: longer than what is left remembers, a tenth of a
/// second at most, with some to spare.
pub const STRETCH: f64 = 1.0;

/// Half widths of a 95 % interval that a candidate has to be better by there: three standard errors, since a dozen are
/// tried in each round.
pub const BETTER: f64 = 1.5;

/// Share by which it has to be better besides: what is certain and less than this is not worth a value.
pub const WORTH: f64 = 0.01;

/// Share of a joint's rate (root mean square) at which dry friction is near its full value there: below what turns take
/// to pass.
pub const SIGN_AT: f64 = 1e-3;

/// Shares of that rate over which friction that builds up or falls is tried: from where filters hide it to a good
/// share of the motion.
pub const BUILDS_UP: [f64; 9] = [0.025, 0.05, 0.075, 0.1, 0.125, 0.175, 0.25, 0.375, 0.625];

/// Share of a value's trace that others do not make up from which recordings of such a machine tell it.
pub const APART: f64 = 1e-3;

/// Median of the size of a normal variable in standard deviations.
pub const MEDIAN: f64 = 0.674_49;
