"""What does the simulation get wrong, why, and how much does a better model gain?

| file                   | answers                                                                            |
|------------------------|------------------------------------------------------------------------------------|
| world.py               | every parameter that could be other than entered, as arrays with batch axes        |
| readings.py            | what the sensors said, as arrays that can be perturbed                             |
| conditioned_state.py   | wrench balance and length compatibility at the measured state                      |
| locked_pose.py         | the pose at locked lengths, beside the measured one                                |
| vibrating_state.py     | the state with what hangs on the platform while vibration is measured, and only then |
| cable_pitch.py         | natural frequencies of single cables at the measured state                         |
| robot_pitch.py         | natural frequencies of the robot at the measured state, followed mode by mode      |
| mode_pairing.py        | which mode of the model is which measured peak?                                    |
| robot_rows.py          | measured robot frequencies beside the exact model's modes                          |
| modal_constants.py     | sizes of measured frequency responses, and of the model's                          |
| commanded.py           | what the simulation commands where no encoder was read                             |
| residuals.py           | all residuals of a campaign for a batch of worlds and readings                     |
| null_model.py          | tolerances and sensor noise as standard normal numbers, and their covariance       |
| causes/                | the library: what may be wrong, with parameters, priors and one function each      |
| evidence.py            | how much better than the null does a cause predict the residuals?                  |
| prepared.py            | everything before the first hypothesis, and whether anything is significant        |
| refit.py               | sizes of a set of causes through the nonlinear residuals, and the evidence there   |
| selection.py           | one cause, several causes, or nothing: forward selection with exchange             |
| remainder.py           | is what is left over still structured? laws outside the library                    |
| setting.py             | from a campaign to the fixed part of its residuals                                 |
| handling_screen.py     | which handling error, if any, explains the residuals?                              |
| suspect_reading.py     | a single reading that contradicts all others, set aside                            |
| wandering_noise.py     | noise of a sensor that is remembered from one reading to the next                  |
| handled_data.py        | what is wrong with the data rather than the robot, in order                        |
| heldout.py             | does the cause predict states and kinds of data that it was not fitted to?         |
| simulation_error.py    | what the user sees: simulated minus measured, in his units                         |
| sigma_check.py         | which sigmas were used, and is one in a wrong unit?                                |
| wording.py             | causes with their sizes, corrections and doubtful peaks, in words                  |
| verdict.py             | the sentence and the result                                                        |
| diagnose.py            | all of the above in order                                                          |
| extended_robot.py      | the robot object that a world means                                                |
| extended_model.py      | the robot with its causes, for every other command                                 |
| plan.py                | before measuring: what can be detected, what be confused                           |
| planned_campaign.py    | the whole plan: detectable, confusable, what to measure next                       |
| planned_states.py      | states that could be measured next, with the model's own readings                  |
| planned_series.py      | several such states in one go, on clamped cables too                               |
| planned_checks.py      | things that could be measured without the robot: weighing, calipers, a thermometer |
| planned_gain.py        | how much better than now would they tell causes apart?                             |
| next_measurement.py    | after measuring: which of these tells apart the causes that are left open?         |
"""
