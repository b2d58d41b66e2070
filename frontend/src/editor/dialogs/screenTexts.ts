/** The texts that a dialog shares with other screens, which the editor does not wait for. */
import { useEffect, useState } from "react";
import { loadScreenTexts } from "@/i18n";

/** Whether they are there. */
export function useScreenTexts(): boolean {
  const [there, setThere] = useState(false);
  useEffect(() => {
    let gone = false;
    void loadScreenTexts().then(
      () => gone || setThere(true),
      () => {},
    );
    return () => {
      gone = true;
    };
  }, []);
  return there;
}
