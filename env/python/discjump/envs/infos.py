"""What `info` holds at every step, and what the end of an episode adds; `env/src/task/info.rs` makes it.

| key | unit | meaning |
|---|---|---|
| distance | m | horizontal distance to the beacon |
| speed | m/s | speed |
| time | s | since the episode's start |
| outside_mission_area | | whether the player is outside the mission area |

and when an episode ends

| key | unit | meaning |
|---|---|---|
| is_success, death, timeout | | how it ended: exactly one of them is true |
| return | | sum of rewards |
| length | decisions | |
| top_speed, mean_speed | m/s | |
| path | m | length of the path |
| damage | damage | at the end; light armor dies at 0.66, medium at 1.0, heavy at 1.32 |
| start_distance | m | horizontal distance to the beacon at the start |
"""
