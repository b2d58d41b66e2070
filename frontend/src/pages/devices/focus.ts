/** Where one goes on by keyboard on the devices' page when what one was at has gone. */
import { useFocusAfter } from "@/design/useReturnFocus";

/** The id of a device's link in the list. */
export const rowId = (device: string) => `device-${device}`;

/** Go on at the device in the list, or at the first one that is there. */
export function useFocusInList(device: string): void {
  useFocusAfter(
    () => document.getElementById(rowId(device)) ?? document.querySelector<HTMLElement>(`[id^="${rowId("")}"]`),
  );
}
