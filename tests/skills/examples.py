"""One instance of every skill, with the inputs it needs, for the tests over all of them."""

import numpy as np
from caretree.sim.robot import model
from caretree.skills.carry_sleeve import CarrySleeve
from caretree.skills.check_laid_out import CheckLaidOut
from caretree.skills.check_sleeve import CheckSleeve
from caretree.skills.find_corner import FindCorner
from caretree.skills.find_stand import FindStand
from caretree.skills.flip_side_check import FlipSideCheck
from caretree.skills.geometry.strap_grip import StrapGrip
from caretree.skills.grasp_sleeve import GraspSleeve
from caretree.skills.hold_still import HoldStill
from caretree.skills.lay_gown import LayGown
from caretree.skills.lay_sleeve import LaySleeve
from caretree.skills.lift_arm import LiftArm
from caretree.skills.look_at_person import LookAtPerson
from caretree.skills.look_for_sleeve import LookForSleeve
from caretree.skills.lower_arm import LowerArm, LowerArmTuning
from caretree.skills.move_joint import MoveJoint
from caretree.skills.navigate import Navigate
from caretree.skills.pre_grasp_manipulate import PreGraspManipulate
from caretree.skills.present_sleeve import PresentSleeve
from caretree.skills.pull_along_arm import PullAlongArm
from caretree.skills.raise_corner import RaiseCorner
from caretree.skills.release_arm import ReleaseArm
from caretree.skills.retreat import Retreat
from caretree.skills.seat_sleeves import SeatSleeves
from caretree.skills.segment_and_grasp import SegmentAndGrasp
from caretree.skills.spread import Spread
from caretree.skills.stretch_neckline import StretchNeckline
from caretree.skills.take_corner import TakeCorner
from caretree.skills.take_down import TakeDown
from caretree.skills.unhook import Unhook
from caretree.skills.view_around import ViewAround, Views
from caretree.trees.tasks.draw_blanket.draw_up import DrawUp
from caretree.trees.tasks.draw_blanket.take_edge import TakeEdge
from caretree.trees.tasks.dressing.check_collar import CheckCollar
from caretree.trees.tasks.dressing.check_face import CheckFace
from caretree.trees.tasks.dressing.check_over_hand import CheckOverHand
from caretree.trees.tasks.dressing.check_worn import CheckWorn
from caretree.trees.tasks.dressing.draw_flat import DrawFlat
from caretree.trees.tasks.dressing.draw_over import DrawOver
from caretree.trees.tasks.dressing.let_gown_go import LetGownGo
from caretree.trees.tasks.dressing.look_at_collar import LookAtCollar
from caretree.trees.tasks.dressing.look_at_sleeves import LookAtSleeves
from caretree.trees.tasks.dressing.take_up import GoToStrap, TakeUpGown
from caretree.trees.tasks.hand_towel.lay_on_hand import LayOnHand
from caretree.trees.tasks.undress.draw_off import DrawOff
from caretree.trees.tasks.undress.take_seam import TakeSeam
from caretree.trees.tasks.wipe_forearm.put_back import PutBack
from caretree.trees.tasks.wipe_forearm.wipe import Wipe

ALWAYS = LowerArmTuning(lies_below=0.0)  # an arm that lies would be left alone
GRIP = StrapGrip(arm="right", hand="right", across_in_hand=np.array((0.0, 1.0, 0.0)))


def hook(context):
    return context.senses.hook(context.world.look("head"))


def pre_grasp_manipulate(context):
    frame = context.world.look("head")
    views = Views(hand="right", frames=(frame,), poses_hand_in_map=(context.world.observe().pose_hand_in_map[1],))
    return PreGraspManipulate("pre-grasp manipulate", context, views=views, min_load=-1.0)


EXAMPLES = {
    CarrySleeve: lambda context: CarrySleeve("carry across", context, side="left"),
    CheckCollar: lambda context: CheckCollar("check collar", context),
    CheckFace: lambda context: CheckFace("check face", context),
    CheckOverHand: lambda context: CheckOverHand("check over hand", context, side="left"),
    CheckLaidOut: lambda context: CheckLaidOut("check laid out", context, side="right"),
    CheckSleeve: lambda context: CheckSleeve("check sleeve", context, side="right"),
    TakeSeam: lambda context: TakeSeam("take seam", context, side="right", hand="left"),
    TakeEdge: lambda context: TakeEdge("take edge", context, side="right", hand="left"),
    CheckWorn: lambda context: CheckWorn("check worn", context, side="right", min_reach=0.7),
    DrawFlat: lambda context: DrawFlat("draw flat", context, side="left", hand="left"),
    DrawOff: lambda context: DrawOff("draw off", context, side="right", hand="left"),
    DrawOver: lambda context: DrawOver("draw over", context),
    DrawUp: lambda context: DrawUp("draw up", context, side="right", hand="right"),
    FindCorner: lambda context: FindCorner("find corner", context),
    FindStand: lambda context: FindStand("find stand", context, side="right", lifting="left", pulling="right"),
    FlipSideCheck: lambda context: FlipSideCheck("flip side check", context),
    GoToStrap: lambda context: GoToStrap("go to strap", context, side="right", hand="left"),
    GraspSleeve: lambda context: GraspSleeve("grasp sleeve", context, side="right", hand="right"),
    LayGown: lambda context: LayGown("lay gown", context, width=0.8),
    LetGownGo: lambda context: LetGownGo("let gown go", context),
    LookAtCollar: lambda context: LookAtCollar("look at collar", context),
    LookAtSleeves: lambda context: LookAtSleeves("look at sleeves", context),
    LayOnHand: lambda context: LayOnHand("lay on hand", context, side="right", hand="right"),
    LaySleeve: lambda context: LaySleeve("lay sleeve", context, side="right", hand="right"),
    LiftArm: lambda context: LiftArm("lift arm", context, side="right", hand="left"),
    LookAtPerson: lambda context: LookAtPerson("look at person", context, side="right"),
    LookForSleeve: lambda context: LookForSleeve("look for the sleeve", context, side="right", hand="right"),
    LowerArm: lambda context: LowerArm("lower arm", context, side="right", hand="left", tuning=ALWAYS),
    Navigate: lambda context: Navigate("navigate", context, goal="rail", arms=model.READY),
    PreGraspManipulate: pre_grasp_manipulate,
    PresentSleeve: lambda context: PresentSleeve("present sleeve", context, grip=GRIP),
    PullAlongArm: lambda context: PullAlongArm("pull along arm", context, grip=GRIP, grip_goal=1.45),
    RaiseCorner: lambda context: RaiseCorner("raise corner", context, hand="right", hook=hook(context), min_load=-1.0),
    PutBack: lambda context: PutBack("put back", context, hand="right", grasp=hook(context)),
    ReleaseArm: lambda context: ReleaseArm("release arm", context, hand="left", lower=True),
    Retreat: lambda context: Retreat("retreat", context, base_distance=0.3),
    SegmentAndGrasp: lambda context: SegmentAndGrasp("segment and grasp", context, hand="right"),
    SeatSleeves: lambda context: SeatSleeves("seat sleeves", context),
    Spread: lambda context: Spread("spread", context),
    StretchNeckline: lambda context: StretchNeckline("stretch neckline", context, max_width=0.7),
    TakeCorner: lambda context: TakeCorner(
        "take corner", context, hand="right", sleeve="left", hook=hook(context), min_load=-1.0
    ),
    TakeUpGown: lambda context: TakeUpGown("take up gown", context, side="right", hand="left"),
    TakeDown: lambda context: TakeDown("take down", context, hook=hook(context), min_load=-1.0, min_load_each=-1.0),
    Unhook: lambda context: Unhook("unhook", context, hand="right", height=0.05),
    ViewAround: lambda context: ViewAround("view around", context, hand="right"),
    Wipe: lambda context: Wipe("wipe", context, side="right", hand="right", strokes=1),
    MoveJoint: lambda context: MoveJoint("move joint", context, side="left", joint="w1", angle=0.3),
    HoldStill: lambda context: HoldStill("hold still", context),
}
