import { useEffect } from "react";

/** What the browser's tab calls the screen; nothing while that is not known yet. */
export function useTitle(title: string | undefined): void {
  useEffect(() => {
    if (title) document.title = `${title} · VIPO`;
  }, [title]);
}
