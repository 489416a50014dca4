"""What `info` holds at every step, and what the end of an episode adds; `env/src/task/info.rs` makes it.

The goal is a beacon, a marker in the air, or a flag: the enemy's, and with it one's own.

| key | unit | meaning |
|---|---|---|
| distance | m | to the goal: of a beacon horizontal, else in space from the feet |
| speed | m/s | speed |
| time | s | since the episode's start |
| outside_mission_area | | whether the player is outside the mission area |

and when an episode ends

| key | unit | meaning |
|---|---|---|
| is_success, death, timeout | | how it ended: exactly one of them is true |
| return | | sum of rewards |
| length | decisions | |
| top_speed | m/s | |
| mean_speed | m/s | horizontal |
| path | m | horizontal length of the path |
| damage | damage | at the end; light armor dies at 0.66, medium at 1.0, heavy at 1.32 |
| start_distance | m | distance to the goal at the start |

and then, in a task or with an option that has it

| key | unit | meaning |
|---|---|---|
| marker_height | m | `DiscJump-v0`: of the marker over the start |
| carrying | | `Route-v0`, `FlagRun-v0`: whether the player had the enemy flag |
| flags_taken | | `Route-v0`, `FlagRun-v0`: how often the player took the enemy flag |
| level | | `curriculum=True`: which difficulty the episode was drawn from, 0 `easy` to 2 `hard` |
| native_return | | with a `reward_fn`: sum of the task's own rewards, `return` being that of its |
"""
