/** Something that is shown this one time, such as a key: to be read, selected and copied. */
import { Button, CopyButton, TextInput } from "@mantine/core";
import { Check, Copy } from "lucide-react";
import styles from "./parts.module.css";

interface SecretFieldProps {
  label: string;
  value: string;
  /** What the button says before and after it was pressed. */
  copy: string;
  copied: string;
}

export function SecretField({ label, value, ...words }: SecretFieldProps) {
  return (
    <div className={styles.secret}>
      <TextInput
        classNames={{ input: styles.mono }}
        label={label}
        readOnly
        data-autofocus
        value={value}
        onFocus={(event) => event.currentTarget.select()}
      />
      <CopyButton value={value} timeout={4000}>
        {({ copied, copy }) => (
          <Button
            variant="default"
            onClick={copy}
            leftSection={copied ? <Check size={16} aria-hidden="true" /> : <Copy size={16} aria-hidden="true" />}
          >
            {copied ? words.copied : words.copy}
          </Button>
        )}
      </CopyButton>
    </div>
  );
}
