"""A reset event for Isaac Lab that puts robots on verified starts. A recipe: NOT RUN HERE, because it needs Isaac Sim.

It is written against the documented interface of Isaac Lab 2 and 3: an event term with a state (`ManagerTermBase`) in
an `EventTermCfg` with mode "reset", `write_root_pose_to_sim` and `env_origins`. Make the pool before the training,
without Isaac Sim, from the mesh that the simulator loads (z up), and with the joints of the robot's default pose:

    world = sf.bake("warehouse.obj", "warehouse.map")
    robot = sf.Robot("anymal.urdf", joints={"LF_HFE": 0.4, "LF_KFE": -0.8})    # and so on
    sf.Pool(world, robot, 1_000_000, columns="clearance").save("starts.npz")

In the configuration of the environment:

    @configclass
    class EventCfg:
        reset_base = EventTermCfg(func=ResetToSpawn, mode="reset",
                                  params={"asset_cfg": SceneEntityCfg("robot"), "file": "starts.npz"})
"""

import torch
from isaaclab.managers import EventTermCfg, ManagerTermBase, SceneEntityCfg

import spawnfield as sf

WXYZ = [0, 1, 2, 6, 3, 4, 5]


class ResetToSpawn(ManagerTermBase):
    """Puts the robots of the environments that reset on the next rows of a pool, without velocity.

    Params:
        asset_cfg: the robot.
        file: of the pool, as `Pool.save` has written it.
        is_tiled: True: each environment has a copy of the world at its origin. False: all share one world, for example
            a terrain that was imported, with env_spacing=0.
    """

    def __init__(self, cfg: EventTermCfg, env):
        super().__init__(cfg, env)
        self.pool = sf.Pool.load(cfg.params["file"], seed=env.cfg.seed)
        self.poses = torch.zeros(env.num_envs, 7, device=env.device)

    def __call__(self, env, env_ids, asset_cfg: SceneEntityCfg, file: str, is_tiled: bool = False):
        mask = torch.zeros(env.num_envs, dtype=torch.bool, device=env.device)
        mask[env_ids] = True
        self.pool.draw(mask, out=self.poses)  # x, y, z and a quaternion x, y, z, w; on the device of the poses
        poses = self.poses[env_ids]
        if is_tiled:
            poses[:, :3] += env.scene.env_origins[env_ids]
        rest = torch.zeros(len(poses), 6, device=env.device)
        robot = env.scene[asset_cfg.name]
        if hasattr(robot, "write_root_pose_to_sim_index"):  # Isaac Lab 3: quaternions x, y, z, w
            robot.write_root_pose_to_sim_index(root_pose=poses, env_ids=env_ids)
            robot.write_root_velocity_to_sim_index(root_velocity=rest, env_ids=env_ids)
        else:  # Isaac Lab 2: w, x, y, z
            robot.write_root_pose_to_sim(poses[:, WXYZ], env_ids=env_ids)
            robot.write_root_velocity_to_sim(rest, env_ids=env_ids)
