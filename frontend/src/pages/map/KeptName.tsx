/** What a thing on the map is called: kept when the field is left or Enter is pressed; Esc takes back what was typed. */
import { TextInput } from "@mantine/core";
import { useSettled, type Keep } from "./useSettled";

interface KeptNameProps {
  label: string;
  name: string;
  keep: Keep<string>;
}

export function KeptName({ label, name, keep }: KeptNameProps) {
  const { value, setValue, settle, takeBack } = useSettled(name, keep);
  const leave = () => (value.trim() ? settle(value.trim()) : takeBack());
  return (
    <TextInput
      label={label}
      maxLength={60}
      value={value}
      onChange={(event) => setValue(event.currentTarget.value)}
      onBlur={leave}
      onKeyDown={(event) => {
        if (event.key === "Enter") leave();
        if (event.key === "Escape") takeBack();
      }}
    />
  );
}
