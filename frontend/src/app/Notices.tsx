/** What appears over every screen, in a script of its own: nobody waits for it to begin. */
import { Notifications } from "@mantine/notifications";
import { NewVersion } from "./NewVersion";

export function Notices() {
  return (
    <>
      <Notifications position="bottom-right" />
      <NewVersion />
    </>
  );
}
