/** Ends what its row tells of. When it goes with that, who pressed it goes on by keyboard elsewhere. */
import { Button } from "@mantine/core";
import { useRef } from "react";
import { useFocusAfter } from "@/design/useReturnFocus";

interface EndProps {
  /** What is read out: beside others of its kind, the words alone do not say what ends. */
  label: string;
  words: string;
  busy: boolean;
  end: () => void;
  /** Who has the focus then. */
  afterwards: () => HTMLElement | null;
}

export function EndButton({ label, words, busy, end, afterwards }: EndProps) {
  const isPressed = useRef(false);
  useFocusAfter(() => (isPressed.current ? afterwards() : null));
  return (
    <Button
      size="xs"
      variant="default"
      c="var(--error)"
      loading={busy}
      aria-label={label}
      onClick={() => {
        isPressed.current = true;
        end();
      }}
    >
      {words}
    </Button>
  );
}
