"""What a pre-grasp action is: pictures around a gown in one hand, and ways of the hand; for who learns and who acts."""
