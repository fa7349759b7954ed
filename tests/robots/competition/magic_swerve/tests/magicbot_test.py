"""The test that comes with magicbot: each autonomous mode, for 15 s."""

from magicbot.magicbot_tests import *  # noqa: F403
