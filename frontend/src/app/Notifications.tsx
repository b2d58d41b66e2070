/** The messages in the corner of the screen, in a script of their own: nobody waits for them to begin. */
export { Notifications } from "@mantine/notifications";
